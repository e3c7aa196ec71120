// SPDX-License-Identifier: Apache-2.0
#include "bench/coded_plane.h"

#include <ctime>
#include <stdexcept>

namespace fieldcast::bench {

namespace {

/// CPU time of this thread; other work on the machine does not count.
double processor_ms() {
    std::timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

} // namespace

std::vector<Coding> all_codings(const std::vector<std::uint32_t>& qualities) {
    std::vector<Coding> codings;
    for (const Codec codec : kAll<Codec>) {
        if (!is_lossy(codec)) {
            codings.push_back({std::string(word_of(codec)), {codec, 0}});
        }
    }
    codings.push_back({"zstd, key frame", {Codec::kZstdFiltered, 0}, true});
    for (const std::uint32_t quality : qualities) {
        for (const Codec codec : kAll<Codec>) {
            if (is_lossy(codec)) {
                const std::string name = std::string(word_of(codec)) + " " + std::to_string(quality);
                const codec::Encoding encoding{codec, static_cast<std::uint8_t>(quality)};
                const bool predicts_views = row_of(codec).predicts_views;
                codings.push_back({name, encoding, false, predicts_views});
                if (predicts_views) {
                    codings.push_back({name + " alone", encoding});
                }
            }
        }
    }
    return codings;
}

CodedPlane code_plane(const Plane& plane, const Coding& coding, const Neighbours& neighbours, float exposure) {
    const Plane* const key = coding.uses_key_frame ? neighbours.before : nullptr;
    const Plane* const base = coding.uses_base ? neighbours.base : nullptr;
    const std::vector<codec::RowBand> bands = codec::strip_bands(plane.height_px);
    std::vector<std::vector<std::byte>> strips(bands.size());
    std::vector<std::vector<std::byte>> base_strips(bands.size());
    for (std::size_t i = 0; base != nullptr && i < bands.size(); ++i) { // a receiver has the base's bands
        base_strips[i] = codec::encode_strip(*base, bands[i], {.encoding = coding.encoding});
    }
    CodedPlane coded;
    const double begin_ms = processor_ms();
    for (std::size_t i = 0; i < bands.size(); ++i) {
        strips[i] = codec::encode_strip(
            plane, bands[i], {.encoding = coding.encoding, .reference = key, .base = base, .exposure = exposure});
        coded.bytes += static_cast<double>(strips[i].size());
    }
    const double encoded_ms = processor_ms();
    coded.decoded = plane;
    coded.decoded.bytes.assign(plane.bytes.size(), std::byte{0});
    const double zeroed_ms = processor_ms();
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const codec::Announced announced{coding.encoding.codec, key, base_strips[i]};
        const auto result = codec::decode_strip(strips[i], bands[i], announced, coded.decoded);
        if (!result) {
            throw std::logic_error(coding.name + ": " + result.error().message);
        }
    }
    coded.decode_ms = processor_ms() - zeroed_ms;
    coded.encode_ms = encoded_ms - begin_ms;
    if (!is_lossy(coding.encoding.codec) && coded.decoded != plane) {
        throw std::logic_error(coding.name + ": lossless, but pixels changed");
    }
    return coded;
}

} // namespace fieldcast::bench
