// SPDX-License-Identifier: Apache-2.0
#include "bench/coded_plane.h"

#include <ctime>
#include <stdexcept>

namespace fieldcast::bench {

namespace {

/// Of this thread: other work on the machine does not count.
double processor_ms() {
    std::timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

} // namespace

std::vector<Coding> all_codings(const std::vector<std::uint32_t>& qualities) {
    std::vector<Coding> codings{{"raw", {codec::CodecId::kRaw, 0}},
                                {"zstd", {codec::CodecId::kZstdFiltered, 0}},
                                {"zstd, key frame", {codec::CodecId::kZstdFiltered, 0}, true}};
    for (const std::uint32_t quality : qualities) {
        const std::string text = std::to_string(quality);
        const auto number = static_cast<std::uint8_t>(quality);
        codings.push_back({"jpeg " + text, {codec::CodecId::kJpeg, number}});
        codings.push_back({"h264 " + text, {codec::CodecId::kH264, number}, false, true});
        codings.push_back({"h264 " + text + " alone", {codec::CodecId::kH264, number}});
    }
    return codings;
}

CodedPlane code_plane(const Plane& plane, const Coding& coding, const Neighbours& neighbours, float exposure) {
    const Plane* const key = coding.uses_key_frame ? neighbours.before : nullptr;
    const Plane* const base = coding.uses_base ? neighbours.base : nullptr;
    const std::vector<codec::RowBand> bands = codec::strip_bands(plane.height_px);
    std::vector<std::vector<std::byte>> strips(bands.size());
    std::vector<std::vector<std::byte>> base_strips(bands.size());
    for (std::size_t i = 0; base != nullptr && i < bands.size(); ++i) { // a receiver has them
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
    if (!codec::is_lossy(coding.encoding.codec) && coded.decoded != plane) {
        throw std::logic_error(coding.name + ": lossless, but pixels changed");
    }
    return coded;
}

} // namespace fieldcast::bench
