// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/frame_assembler.h"
#include "tests/fuzz/input.h"

#include <optional>

namespace fieldcast::fuzz {

/// A client's assembler, fed with chunks from anywhere. Sets the checksum of every trailer to what it should be.
class ReceivedChunks {
public:
    explicit ReceivedChunks(wire::Decoding decoding = wire::Decoding::kFull) : assembler_(nullptr, decoding) {}

    void begin_epoch(std::uint32_t epoch, const wire::FrameLimits& limits);
    void abort(std::uint64_t frame_id) { assembler_.abort(frame_id); }

    /// The frame that `chunk` completes. Checks that it is whole.
    std::optional<wire::ReceivedFrame> add(v1::FrameChunk chunk);

    std::size_t error_count() const { return error_count_; }

private:
    wire::FrameAssembler assembler_;
    wire::FrameLimits limits_;
    std::uint32_t crc32c_ = 0; ///< of the payloads since the last header
    std::size_t error_count_ = 0;
};

} // namespace fieldcast::fuzz
