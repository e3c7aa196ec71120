// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/encoded_frame.h"
#include "server/recording/record.h"

namespace fieldcast::recording {

/// Beginning of a frame's record.
struct FrameMark {
    std::uint64_t frame_id = 0;     ///< > 0, as recorded
    std::uint64_t key_frame_id = 0; ///< key frame that strips refer to; its own id: it is a key frame; 0: none
    std::int64_t at_ns = 0;         ///< time since the first frame of the recording

    bool is_key() const { return key_frame_id == frame_id; }
};

inline constexpr std::size_t kFrameMarkBytes = 28; ///< the mark, and the length of the message behind it

/// A frame as the pieces of one record. Strips are not copied: their pieces refer to the frame's bytes.
struct FrameRecord {
    Bytes head; ///< mark, length of the message, message
    std::vector<Piece> pieces; ///< head, then all strips

    FrameRecord() = default;
    FrameRecord(FrameRecord&&) = default;
    FrameRecord& operator=(FrameRecord&&) = default;
};

/// The record of those parts of `frame` that `demand` names. `frame` must have all of them and outlive the result, and
/// each of their strips must have a form that stands alone. With `mark.key_frame_id` 0, only these forms are kept.
FrameRecord to_record(const feed::EncodedFrame& frame, const FrameMark& mark, const feed::Demand& demand);

/// The mark at the beginning of a record's content; its numbers are not checked.
Decoded<FrameMark> mark_from_bytes(std::span<const std::byte> content);

/// A frame's record as it was read, not yet checked.
struct FrameContent {
    RecordHead head;
    Bytes bytes;
};

/// The frame as it was recorded, with its recorded ids. The CRC is checked while strips are copied. Needs as much
/// memory as the content.
Decoded<feed::EncodedFrame> frame_from_content(const FrameContent& content, const feed::Demand& demand);

} // namespace fieldcast::recording
