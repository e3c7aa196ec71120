// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recording_index.h"

#include "core/codec/crc32c.h"

namespace fieldcast::recording {

namespace {

constexpr std::size_t kNumberBytes = 8;
constexpr std::size_t kEntryBytes = 4 * kNumberBytes;
const std::uint64_t kEndBytes = kNumberBytes + kEndMagic.size();

constexpr std::uint64_t kMaxFrameId = 1ULL << 48;
constexpr std::int64_t kMaxTime_ns = 10'000'000'000'000'000; ///< 115 days: sums of a few stay far below 2^63

/// Checks that the frames of a file are in order.
class OrderCheck {
public:
    /// Why `mark` cannot follow the marks before; null: it can.
    const char* problem_of(const FrameMark& mark) {
        if (mark.frame_id == 0 || mark.frame_id > kMaxFrameId || mark.at_ns < 0 || mark.at_ns > kMaxTime_ns) {
            return "frame ids must be 1 to 2^48, and times 0 to 1e16 ns";
        }
        if (mark.frame_id <= last_id_ || mark.at_ns < last_at_ns_) {
            return "frame ids must increase, and times must not decrease";
        }
        if (!mark.is_key() && mark.key_frame_id != 0 && mark.key_frame_id != last_key_id_) {
            return "a frame refers to a key frame that is not the last one before it";
        }
        last_id_ = mark.frame_id;
        last_at_ns_ = mark.at_ns;
        last_key_id_ = mark.is_key() ? mark.frame_id : last_key_id_;
        return nullptr;
    }

private:
    std::uint64_t last_id_ = 0;
    std::uint64_t last_key_id_ = 0;
    std::int64_t last_at_ns_ = 0;
};

IndexEntry entry_from_bytes(std::span<const std::byte> bytes) {
    return {.mark = {.frame_id = number_at(bytes, kNumberBytes),
                     .key_frame_id = number_at(bytes.subspan(kNumberBytes), kNumberBytes),
                     .at_ns = static_cast<std::int64_t>(number_at(bytes.subspan(2 * kNumberBytes), kNumberBytes))},
            .offset = number_at(bytes.subspan(3 * kNumberBytes), kNumberBytes)};
}

/// Offset of the index record, read from the end of the file; empty: the file was not finished.
std::optional<std::uint64_t> index_offset(std::istream& file, std::uint64_t file_bytes) {
    if (file_bytes < kEndBytes) {
        return std::nullopt;
    }
    std::string end(kEndBytes, '\0');
    file.clear();
    file.seekg(static_cast<std::streamoff>(file_bytes - kEndBytes));
    file.read(end.data(), static_cast<std::streamsize>(end.size()));
    if (!file.good() || !end.ends_with(kEndMagic)) {
        return std::nullopt;
    }
    return number_at(std::as_bytes(std::span(end)), kNumberBytes);
}

} // namespace

void write_index(std::ostream& file, std::uint64_t offset, std::span<const IndexEntry> frames) {
    Bytes bytes;
    for (const IndexEntry& entry : frames) {
        append_number(bytes, entry.mark.frame_id, kNumberBytes);
        append_number(bytes, entry.mark.key_frame_id, kNumberBytes);
        append_number(bytes, static_cast<std::uint64_t>(entry.mark.at_ns), kNumberBytes);
        append_number(bytes, entry.offset, kNumberBytes);
    }
    const Piece piece{.bytes = bytes, .crc32c = codec::crc32c(bytes)};
    write_record(file, RecordKind::kIndex, {&piece, 1});
    Bytes end;
    append_number(end, offset, kNumberBytes);
    file.write(reinterpret_cast<const char*>(end.data()), static_cast<std::streamsize>(end.size()));
    file.write(kEndMagic.data(), static_cast<std::streamsize>(kEndMagic.size()));
}

Decoded<RecordingIndex> read_index(std::istream& file, std::uint64_t frames_begin, std::uint64_t file_bytes) {
    const auto offset = index_offset(file, file_bytes);
    if (!offset) {
        return decode_error("the file has no index at its end");
    }
    const auto bytes = read_record(file, *offset, file_bytes - kEndBytes, RecordKind::kIndex);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    if (bytes->size() % kEntryBytes != 0) {
        return decode_error("index: " + std::to_string(bytes->size()) + " bytes are not a multiple of " +
                            std::to_string(kEntryBytes));
    }
    RecordingIndex index;
    OrderCheck order;
    std::uint64_t least_offset = frames_begin;
    for (std::size_t i = 0; i < bytes->size(); i += kEntryBytes) {
        const IndexEntry entry = entry_from_bytes(std::span(*bytes).subspan(i));
        const char* const problem = order.problem_of(entry.mark);
        if (problem != nullptr || entry.offset < least_offset || entry.offset >= *offset) {
            return decode_error(std::string("index: ") +
                                (problem != nullptr ? problem : "a frame lies outside of the file"));
        }
        least_offset = entry.offset + kRecordHeadBytes;
        index.frames.push_back(entry);
    }
    return index;
}

RecordingIndex scan_frames(std::istream& file, std::uint64_t frames_begin, std::uint64_t file_bytes) {
    RecordingIndex index;
    OrderCheck order;
    for (std::uint64_t offset = frames_begin; offset < file_bytes;) {
        const auto content = read_record(file, offset, file_bytes, RecordKind::kFrame);
        const auto mark = content ? mark_from_bytes(*content) : tl::unexpected(content.error());
        const char* const problem = mark ? order.problem_of(*mark) : nullptr;
        if (!mark || problem != nullptr) {
            index.ignored = std::to_string(file_bytes - offset) + " bytes from byte " + std::to_string(offset) +
                            " on: " + (mark ? problem : mark.error().message);
            return index;
        }
        index.frames.push_back({.mark = *mark, .offset = offset});
        offset += kRecordHeadBytes + content->size();
    }
    return index;
}

} // namespace fieldcast::recording
