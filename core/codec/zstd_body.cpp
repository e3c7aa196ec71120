// SPDX-License-Identifier: Apache-2.0
#include "core/codec/zstd_body.h"

#include <memory>
#include <string>
#include <zstd.h>

namespace fieldcast::codec {

namespace {

constexpr int kZstdLevel = 1;
constexpr std::size_t kKeptScratchBytes = 4U << 20;

/// Memory for one strip, reused by the next strip of this thread; large blocks are not kept.
class Scratch {
public:
    explicit Scratch(std::size_t size) {
        if (buffer().size() < size) {
            buffer().resize(size);
        }
        bytes_ = std::span(buffer()).first(size);
    }
    ~Scratch() {
        if (buffer().size() > kKeptScratchBytes) {
            std::vector<std::byte>().swap(buffer());
        }
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    std::span<std::byte> bytes() const { return bytes_; }

private:
    static std::vector<std::byte>& buffer() {
        thread_local std::vector<std::byte> instance;
        return instance;
    }
    std::span<std::byte> bytes_;
};

} // namespace

bool append_zstd(ByteFilter filter, BandSize size, std::span<const std::byte> pixels,
                 std::span<const std::byte> reference, std::vector<std::byte>& out) {
    thread_local const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
    const Scratch filtered(pixels.size());
    filter_band(filter, size, pixels, reference, filtered.bytes());
    const std::size_t start = out.size();
    out.resize(start + ZSTD_compressBound(pixels.size()));
    const std::size_t written = ZSTD_compressCCtx(context.get(), &out[start], out.size() - start,
                                                  filtered.bytes().data(), pixels.size(), kZstdLevel);
    FC_ASSERT(ZSTD_isError(written) == 0, "zstd refused a buffer of its own bound");
    out.resize(start + written);
    return written < pixels.size();
}

Decoded<void> decode_zstd(ByteFilter filter, BandSize size, std::span<const std::byte> body,
                          std::span<const std::byte> reference, std::span<std::byte> pixels) {
    thread_local const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
    if (ZSTD_getFrameContentSize(body.data(), body.size()) != pixels.size()) {
        return decode_error("strip: zstd frame does not declare the " + std::to_string(pixels.size()) +
                            " bytes of its rows");
    }
    if (ZSTD_findFrameCompressedSize(body.data(), body.size()) != body.size()) {
        return decode_error("strip: not exactly one zstd frame");
    }
    const Scratch filtered(pixels.size());
    const std::size_t read =
        ZSTD_decompressDCtx(context.get(), filtered.bytes().data(), pixels.size(), body.data(), body.size());
    if (read != pixels.size()) {
        return decode_error(std::string("strip: zstd: ") +
                            (ZSTD_isError(read) != 0 ? ZSTD_getErrorName(read) : "too few bytes"));
    }
    unfilter_band(filter, size, filtered.bytes(), reference, pixels);
    return {};
}

} // namespace fieldcast::codec
