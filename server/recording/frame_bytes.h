// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/encoded_frame.h"
#include "server/recording/record.h"

namespace fieldcast::recording {

/// What a frame's record begins with.
struct FrameMark {
    std::uint64_t frame_id = 0;     ///< > 0, as recorded
    std::uint64_t key_frame_id = 0; ///< that strips refer to; its own id: it is a key frame; 0: there is none
    std::int64_t at_ns = 0;         ///< since the first frame of the recording

    bool is_key() const { return key_frame_id == frame_id; }
};

inline constexpr std::size_t kFrameMarkBytes = 28; ///< with the length of what follows

/// A frame as the pieces of one record. The strips' bytes are the frame's own.
struct FrameRecord {
    Bytes head; ///< mark, length of the message, message
    std::vector<Piece> pieces; ///< head, then all strips

    FrameRecord() = default;
    FrameRecord(FrameRecord&&) = default;
    FrameRecord& operator=(FrameRecord&&) = default;
};

/// The parts of `frame` that `demand` names, which it must cover and of which every strip must have a form that stands
/// alone. `frame` must outlive the result. With `mark.key_frame_id` 0, only the forms that stand alone are kept.
FrameRecord to_record(const feed::EncodedFrame& frame, const FrameMark& mark, const feed::Demand& demand);

/// The mark at the beginning of a record's content; its numbers are not checked.
Decoded<FrameMark> mark_from_bytes(std::span<const std::byte> content);

/// A frame's record as it was read.
struct FrameContent {
    RecordHead head;
    Bytes bytes;
};

/// The frame as it was recorded, with its ids. The CRC is compared while strips are copied. Memory: as large as
/// the content.
Decoded<feed::EncodedFrame> frame_from_content(const FrameContent& content, const feed::Demand& demand);

} // namespace fieldcast::recording
