// SPDX-License-Identifier: Apache-2.0
#include "server/recording/frame_bytes.h"

#include "core/codec/crc32c.h"
#include "core/wire/convert.h"

#include "fieldcast/v1/recording.pb.h"

#include <algorithm>

namespace fieldcast::recording {

namespace {

constexpr std::size_t kIdBytes = 8;
constexpr std::size_t kLengthBytes = 4;

/// Appends strips of planes: their sizes to a message, their bytes to the pieces of a record.
class StripWriter {
public:
    StripWriter(FrameRecord& record, bool has_key_frame) : record_(record), has_key_frame_(has_key_frame) {}

    template <class Message> void add(const wire::EncodedPlane& plane, Message& message) {
        for (const wire::EncodedStrip& strip : plane.strips) {
            const wire::StripBytes& best = has_key_frame_ ? strip.best : strip.alone;
            const bool is_same = best.bytes == strip.alone.bytes;
            v1::FrameStrip& entry = *message.add_strips();
            entry.set_first_row(strip.band.first_row);
            entry.set_row_count(strip.band.row_count);
            entry.set_best_bytes(append(best));
            entry.set_alone_bytes(is_same ? 0 : append(strip.alone));
        }
    }

private:
    std::uint32_t append(const wire::StripBytes& strip) {
        FC_ASSERT(strip.bytes != nullptr, "a recorded strip must have a form that stands alone");
        record_.pieces.push_back({.bytes = *strip.bytes, .crc32c = strip.crc32c});
        return static_cast<std::uint32_t>(strip.bytes->size());
    }

    FrameRecord& record_;
    const bool has_key_frame_;
};

v1::RecordedFrame message_of(const feed::EncodedFrame& frame, const feed::Demand& demand, StripWriter& strips) {
    v1::RecordedFrame message;
    wire::to_proto(frame.header, *message.mutable_header());
    wire::to_proto(frame.times, *message.mutable_times());
    if (!demand.planes.empty()) {
        wire::to_proto(frame.source->header, *message.mutable_planes_header());
    }
    for (const wire::PlaneChoice& choice : demand.planes) {
        const wire::EncodedPlane& plane = *frame.source->find(choice);
        v1::FramePlane& entry = *message.add_planes();
        entry.set_width_px(plane.width_px);
        entry.set_height_px(plane.height_px);
        strips.add(plane, entry);
    }
    for (const feed::ViewDemand& wanted : demand.views) {
        const wire::EncodedViews& views = *feed::find_views(frame, wanted.format);
        v1::FrameViews& entry = *message.add_views();
        wire::to_proto(views.header, *entry.mutable_header());
        for (const LatticePosition position : wanted.positions) {
            const wire::EncodedView& view = views.views.at(position);
            v1::FrameView& part = *entry.add_views();
            wire::to_proto(view.discards, *part.mutable_discards());
            strips.add(view.image, part);
        }
    }
    return message;
}

/// Reads strips from a record's content, one after the other, and combines their CRCs.
class StripReader {
public:
    StripReader(std::span<const std::byte> bytes, std::uint32_t crc32c) : rest_(bytes), crc32c_(crc32c) {}

    template <class Message> Decoded<void> read(const Message& message, wire::EncodedPlane& plane) {
        std::uint32_t next_row = 0;
        for (const v1::FrameStrip& entry : message.strips()) {
            if (entry.first_row() != next_row || entry.row_count() == 0 ||
                entry.row_count() > plane.height_px - next_row) {
                return decode_error("frame: strips must cover their plane from the top without gaps");
            }
            next_row += entry.row_count();
            wire::EncodedStrip strip{.band = {entry.first_row(), entry.row_count()}};
            const std::uint64_t limit = codec::max_strip_bytes(plane.format, plane.width_px, entry.row_count());
            if (!take(entry.best_bytes(), limit, strip.best)) {
                return decode_error("frame: a strip of " + std::to_string(entry.best_bytes()) +
                                    " bytes; allowed are 1 to " +
                                    std::to_string(std::min<std::uint64_t>(limit, rest_.size())));
            }
            strip.alone = strip.best;
            if (entry.alone_bytes() != 0 && !take(entry.alone_bytes(), limit, strip.alone)) {
                return decode_error("frame: a strip that stands alone has " + std::to_string(entry.alone_bytes()) +
                                    " bytes");
            }
            plane.strips.push_back(std::move(strip));
        }
        return next_row == plane.height_px ? Decoded<void>{} : decode_error("frame: a plane lacks rows");
    }

    bool is_at_end() const { return rest_.empty(); }
    std::uint32_t crc32c() const { return crc32c_; }

private:
    bool take(std::uint32_t bytes, std::uint64_t limit, wire::StripBytes& strip) {
        if (bytes == 0 || bytes > limit || bytes > rest_.size()) {
            return false;
        }
        const auto taken = rest_.first(bytes);
        rest_ = rest_.subspan(bytes);
        strip.bytes = std::make_shared<const Bytes>(taken.begin(), taken.end());
        strip.crc32c = codec::crc32c(taken);
        crc32c_ = codec::crc32c_combine(crc32c_, strip.crc32c, bytes);
        return true;
    }

    std::span<const std::byte> rest_;
    std::uint32_t crc32c_;
};

Decoded<void> read_source(const v1::RecordedFrame& message, const feed::Demand& demand, StripReader& strips,
                          feed::EncodedFrame& frame) {
    const auto header = wire::from_proto(message.planes_header(), frame.header.frame_id);
    if (!header) {
        return tl::unexpected(header.error());
    }
    frame.source.emplace(wire::EncodedSource{.header = *header, .key_frame_id = frame.key_frame_id, .planes = {}});
    for (std::size_t i = 0; i < demand.planes.size(); ++i) {
        const wire::PlaneChoice& choice = demand.planes[i];
        const v1::FramePlane& entry = message.planes(static_cast<int>(i));
        wire::EncodedPlane plane{.semantic = choice.semantic,
                                 .format = wire::format_of(choice),
                                 .encoding = choice.encoding,
                                 .width_px = entry.width_px(),
                                 .height_px = entry.height_px(),
                                 .strips = {}};
        if (plane.width_px != plane_width(*header, choice.semantic) ||
            plane.height_px != plane_height(*header, choice.semantic)) {
            return decode_error("frame: a plane does not have the size of its source");
        }
        if (const auto read = strips.read(entry, plane); !read) {
            return read;
        }
        frame.source->planes.push_back(std::move(plane));
    }
    return {};
}

Decoded<void> read_views(const v1::FrameViews& message, const feed::ViewDemand& wanted, StripReader& strips,
                         feed::EncodedFrame& frame) {
    const auto header = wire::from_proto(message.header(), frame.header.frame_id);
    if (!header) {
        return tl::unexpected(header.error());
    }
    if (static_cast<std::size_t>(message.views_size()) != wanted.positions.size()) {
        return decode_error("frame: " + std::to_string(message.views_size()) + " views, " +
                            std::to_string(wanted.positions.size()) + " were recorded");
    }
    wire::EncodedViews views{
        .header = *header, .format = wanted.format, .key_frame_id = frame.key_frame_id, .views = {}};
    for (std::size_t i = 0; i < wanted.positions.size(); ++i) {
        const v1::FrameView& entry = message.views(static_cast<int>(i));
        wire::EncodedView view{.image = {.encoding = wanted.format.encoding,
                                         .width_px = wanted.format.width_px,
                                         .height_px = wanted.format.height_px,
                                         .strips = {}},
                               .discards = wire::from_proto(entry.discards())};
        if (const auto read = strips.read(entry, view.image); !read) {
            return read;
        }
        views.views.emplace(wanted.positions[i], std::move(view));
    }
    frame.views.push_back(std::move(views));
    return {};
}

Decoded<void> read_parts(const v1::RecordedFrame& message, const feed::Demand& demand, StripReader& strips,
                         feed::EncodedFrame& frame) {
    if (static_cast<std::size_t>(message.planes_size()) != demand.planes.size() ||
        static_cast<std::size_t>(message.views_size()) != demand.views.size()) {
        return decode_error("frame: its forms differ from those of the recording");
    }
    if (!demand.planes.empty()) {
        if (const auto read = read_source(message, demand, strips, frame); !read) {
            return read;
        }
    }
    for (std::size_t i = 0; i < demand.views.size(); ++i) {
        const auto read = read_views(message.views(static_cast<int>(i)), demand.views[i], strips, frame);
        if (!read) {
            return read;
        }
    }
    return strips.is_at_end() ? Decoded<void>{} : decode_error("frame: it has more bytes than its strips");
}

} // namespace

FrameRecord to_record(const feed::EncodedFrame& frame, const FrameMark& mark, const feed::Demand& demand) {
    FrameRecord record;
    record.pieces.emplace_back(); // filled with the head below
    StripWriter strips(record, mark.key_frame_id != 0);
    const v1::RecordedFrame message = message_of(frame, demand, strips);
    append_number(record.head, mark.frame_id, kIdBytes);
    append_number(record.head, mark.key_frame_id, kIdBytes);
    append_number(record.head, static_cast<std::uint64_t>(mark.at_ns), kIdBytes);
    append_number(record.head, message.ByteSizeLong(), kLengthBytes);
    record.head.resize(kFrameMarkBytes + message.ByteSizeLong());
    message.SerializeToArray(record.head.data() + kFrameMarkBytes,
                             static_cast<int>(record.head.size() - kFrameMarkBytes));
    record.pieces.front() = {.bytes = record.head, .crc32c = codec::crc32c(record.head)};
    return record;
}

Decoded<FrameMark> mark_from_bytes(std::span<const std::byte> content) {
    if (content.size() < kFrameMarkBytes) {
        return decode_error("frame: " + std::to_string(content.size()) + " bytes, at least " +
                            std::to_string(kFrameMarkBytes) + " needed");
    }
    return FrameMark{.frame_id = number_at(content, kIdBytes),
                     .key_frame_id = number_at(content.subspan(kIdBytes), kIdBytes),
                     .at_ns = static_cast<std::int64_t>(number_at(content.subspan(2 * kIdBytes), kIdBytes))};
}

Decoded<feed::EncodedFrame> frame_from_content(const FrameContent& content, const feed::Demand& demand) {
    const std::span<const std::byte> bytes(content.bytes);
    const auto mark = mark_from_bytes(bytes);
    if (!mark) {
        return tl::unexpected(mark.error());
    }
    const std::uint64_t message_bytes = number_at(bytes.subspan(3 * kIdBytes), kLengthBytes);
    v1::RecordedFrame message;
    if (message_bytes > bytes.size() - kFrameMarkBytes ||
        !message.ParseFromArray(bytes.data() + kFrameMarkBytes, static_cast<int>(message_bytes))) {
        return decode_error("frame: it contains no fieldcast.v1.RecordedFrame");
    }
    const auto header = wire::from_proto(message.header(), mark->frame_id);
    if (!header) {
        return tl::unexpected(header.error());
    }
    feed::EncodedFrame frame{.header = *header,
                             .times = wire::from_proto(message.times()),
                             .key_frame_id = mark->key_frame_id,
                             .source = std::nullopt,
                             .views = {}};
    const std::size_t strips_begin = kFrameMarkBytes + message_bytes;
    StripReader strips(bytes.subspan(strips_begin),
                       codec::crc32c(bytes.first(strips_begin), content.head.head_crc32c));
    if (const auto read = read_parts(message, demand, strips, frame); !read) {
        return tl::unexpected(read.error());
    }
    if (strips.crc32c() != content.head.crc32c) {
        return decode_error("frame: its CRC is wrong");
    }
    return frame;
}

} // namespace fieldcast::recording
