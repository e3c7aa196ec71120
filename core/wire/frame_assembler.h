// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/lightfield/views.h"
#include "core/wire/frame_limits.h"
#include "core/wire/server_times.h"
#include "core/wire/view_set.h"

#include "fieldcast/v1/frame.pb.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace fieldcast::wire {

/// Decoded views, in the row-major order of `set.grid`.
struct ReceivedViews {
    ViewSet set;
    Views views;
};

/// How much of a frame is checked and decoded. kChecksum and kHeaders are for measurements, which need no pixels.
enum class Decoding : std::uint8_t {
    kFull,     ///< planes are decoded
    kChecksum, ///< chunks must be complete, in order and undamaged; planes stay empty
    kHeaders,  ///< chunks must be complete and in order; the CRC is not computed; planes stay empty
};

/// A complete frame that has passed the checks of its Decoding, such as the CRC.
struct ReceivedFrame {
    std::uint32_t epoch = 0;
    std::variant<SourceFrame, ReceivedViews> content;
    ServerTimes server_times;
    std::uint64_t payload_bytes = 0;
    std::chrono::nanoseconds decode_time{0}; ///< spent in this frame's `add` calls

    const FrameHeader& header() const;
};

/// Assembles frames from the chunks of one stream, in order of arrival, and decodes strips as they complete.
/// Not thread-safe. Hostile input causes DecodeErrors, never a crash. Memory stays within the limits: decoded frame +
/// planes of the last key frame + one encoded strip per pool thread + one encoded view + scratch of decode_strip.
///
///     assembler.begin_epoch(configured.epoch(), limits);
///     auto added = assembler.add(std::move(*message.mutable_frame_chunk()));
///     if (!added) { ack(FAILED); }             // `add` skips the rest of this frame, until the next header
///     else if (*added) { show(**added); }      // the frame is complete
class FrameAssembler {
public:
    /// `pool` decodes and must outlive this; null: the calling thread decodes.
    explicit FrameAssembler(WorkerPool* pool = nullptr, Decoding decoding = Decoding::kFull);
    ~FrameAssembler();

    /// Call it before the first chunk of an epoch. Drops an unfinished frame and the key frame; ids may start again.
    void begin_epoch(std::uint32_t epoch, const FrameLimits& limits);

    /// Returns the frame if `chunk` was its trailer, nothing while the frame is incomplete or skipped.
    Decoded<std::optional<ReceivedFrame>> add(v1::FrameChunk chunk);

    /// Handles FrameAborted: drops the frame with that id and skips its remaining chunks.
    void abort(std::uint64_t frame_id);

private:
    struct Frame;
    /// The last key frame.
    struct Key {
        std::uint64_t frame_id = 0;
        std::vector<Plane> planes; ///< one per part; pixels only with Decoding::kFull
    };
    Decoded<void> begin_frame(const v1::FrameChunk& chunk);
    Decoded<std::optional<ReceivedFrame>> add_to_frame(v1::FrameChunk& chunk);
    Decoded<void> check_order(const v1::FrameChunk& chunk) const;
    void keep_key_frame();

    std::unique_ptr<Frame> frame_; ///< in progress, or null
    WorkerPool* pool_;
    Decoding decoding_;
    FrameLimits limits_;
    std::uint32_t epoch_ = 0;
    std::optional<std::uint64_t> last_frame_id_; ///< of the newest header of this epoch
    std::optional<std::uint64_t> skipped_id_;    ///< of the frame whose chunks are ignored
    std::optional<Key> key_;
};

} // namespace fieldcast::wire
