// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/wire/chunks.h"

#include "fieldcast/v1/frame.pb.h"

#include <chrono>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace fieldcast::wire {

/// What one frame may claim; anything beyond is a DecodeError before it is allocated. Set it from Configured.
struct FrameLimits {
    std::uint32_t max_width_px = 4096;              ///< of a plane (with guard band) or a view
    std::uint32_t max_height_px = 4096;             ///< of a plane (with guard band) or a view
    std::uint64_t max_frame_bytes = 512ULL << 20;   ///< decoded bytes of all planes or views of a frame
    std::uint32_t max_chunk_bytes = kMaxChunkBytes; ///< payload of one chunk
};

/// Which views a frame of views has.
struct ViewSet {
    ViewGrid grid;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    float fovy_rad = 1.0F; ///< vertical, over height_px

    bool operator==(const ViewSet&) const = default;
};

struct ReceivedViews {
    ViewSet set;
    Views views;
};

/// How much of a frame is looked at. Everything but kFull is for measuring: pixels are thrown away.
enum class Decoding : std::uint8_t {
    kFull,     ///< planes are decoded
    kChecksum, ///< chunks must be complete, in order and undamaged; planes stay empty
    kHeaders,  ///< chunks must be complete and in order; the CRC is not computed; planes stay empty
};

/// A complete frame whose CRC was right (see Decoding).
struct ReceivedFrame {
    std::uint32_t epoch = 0;
    std::variant<SourceFrame, ReceivedViews> content;
    ServerTimes server_times;
    std::uint64_t payload_bytes = 0;
    std::chrono::nanoseconds decode_time{0}; ///< spent in this frame's `add` calls

    const FrameHeader& header() const;
};

/// Puts the chunks of one stream together, in the order in which they arrive, and decodes strips as they complete.
/// Not thread-safe. Hostile input gives DecodeErrors, never a crash or more memory than the limits allow
/// (decoded frame + planes of the last key frame + one encoded strip per pool thread + one encoded view + scratch of
/// decode_strip).
///
///     assembler.begin_epoch(configured.epoch(), limits);
///     auto added = assembler.add(std::move(*message.mutable_frame_chunk()));
///     if (!added) { ack(FAILED); }             // rest of this frame is skipped, the next header starts afresh
///     else if (*added) { show(**added); }      // a frame is complete
class FrameAssembler {
public:
    /// Decodes with `pool`, which must outlive this; null: on the calling thread only.
    explicit FrameAssembler(WorkerPool* pool = nullptr, Decoding decoding = Decoding::kFull);
    ~FrameAssembler();

    /// Frames of this epoch follow. Drops an unfinished frame and the key frame; frame ids start anew.
    void begin_epoch(std::uint32_t epoch, const FrameLimits& limits);

    /// The frame, if `chunk` was its trailer; nothing while it is incomplete or skipped.
    Decoded<std::optional<ReceivedFrame>> add(v1::FrameChunk chunk);

    /// FrameAborted arrived: an unfinished frame of that id is dropped; chunks of it that still follow are skipped.
    void abort(std::uint64_t frame_id);

private:
    struct Frame;
    struct Key { ///< the last key frame
        std::uint64_t frame_id = 0;
        std::vector<Plane> planes; ///< by part; without pixels unless they are decoded
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
    std::optional<std::uint64_t> last_frame_id_; ///< newest header seen in this epoch
    std::optional<std::uint64_t> skipped_id_;    ///< chunks of this frame are ignored
    std::optional<Key> key_;
};

} // namespace fieldcast::wire
