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
        codings.push_back(
            {"jpeg " + std::to_string(quality), {codec::CodecId::kJpeg, static_cast<std::uint8_t>(quality)}});
    }
    return codings;
}

CodedPlane code_plane(const Plane& plane, const Coding& coding, const Plane* reference, float exposure) {
    const Plane* const key = coding.uses_key_frame ? reference : nullptr;
    const std::vector<codec::RowBand> bands = codec::strip_bands(plane.height_px);
    std::vector<std::vector<std::byte>> strips(bands.size());
    CodedPlane coded;
    const double begin_ms = processor_ms();
    for (std::size_t i = 0; i < bands.size(); ++i) {
        strips[i] = codec::encode_strip(
            plane, bands[i], {.encoding = coding.encoding, .reference = key, .exposure = exposure});
        coded.bytes += static_cast<double>(strips[i].size());
    }
    const double encoded_ms = processor_ms();
    coded.decoded = plane;
    coded.decoded.bytes.assign(plane.bytes.size(), std::byte{0});
    const double zeroed_ms = processor_ms();
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const auto result = codec::decode_strip(strips[i], bands[i], {coding.encoding.codec, key}, coded.decoded);
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
