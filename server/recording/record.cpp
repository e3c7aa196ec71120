// SPDX-License-Identifier: Apache-2.0
#include "server/recording/record.h"

#include "core/codec/crc32c.h"

#include <array>

namespace fieldcast::recording {

namespace {

constexpr std::size_t kKindBytes = 4;
constexpr std::size_t kLengthBytes = 4;
constexpr std::size_t kCrcBytes = 4;

bool is_known(std::uint64_t kind) {
    return kind >= static_cast<std::uint64_t>(RecordKind::kChannel) &&
           kind <= static_cast<std::uint64_t>(RecordKind::kIndex);
}

void write_bytes(std::ostream& file, std::span<const std::byte> bytes) {
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

bool read_bytes(std::istream& file, std::uint64_t offset, std::span<std::byte> bytes) {
    file.clear();
    file.seekg(static_cast<std::streamoff>(offset));
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file.good();
}

std::string place(std::uint64_t offset) {
    return "record at byte " + std::to_string(offset) + ": ";
}

} // namespace

void append_number(Bytes& bytes, std::uint64_t value, std::size_t width) {
    for (std::size_t i = 0; i < width; ++i) {
        bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
    }
}

std::uint64_t number_at(std::span<const std::byte> bytes, std::size_t width) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < width; ++i) {
        value |= static_cast<std::uint64_t>(bytes[i]) << (8 * i);
    }
    return value;
}

void write_record(std::ostream& file, RecordKind kind, std::span<const Piece> pieces) {
    std::uint64_t content_bytes = 0;
    for (const Piece& piece : pieces) {
        content_bytes += piece.bytes.size();
    }
    if (content_bytes > kMaxRecordBytes) {
        throw UserError("recording: " + std::to_string(content_bytes) + " bytes in one record, at most " +
                        std::to_string(kMaxRecordBytes) + "; record fewer or smaller forms");
    }
    Bytes head;
    append_number(head, static_cast<std::uint32_t>(kind), kKindBytes);
    append_number(head, content_bytes, kLengthBytes);
    std::uint32_t crc32c = codec::crc32c(head);
    for (const Piece& piece : pieces) {
        crc32c = codec::crc32c_combine(crc32c, piece.crc32c, piece.bytes.size());
    }
    append_number(head, crc32c, kCrcBytes);
    write_bytes(file, head);
    for (const Piece& piece : pieces) {
        write_bytes(file, piece.bytes);
    }
}

Decoded<RecordHead> read_head(std::istream& file, std::uint64_t offset, std::uint64_t file_bytes) {
    std::array<std::byte, kRecordHeadBytes> bytes{};
    if (offset > file_bytes || file_bytes - offset < bytes.size() || !read_bytes(file, offset, bytes)) {
        return decode_error(place(offset) + "the file ends within its head");
    }
    const std::span<const std::byte> head(bytes);
    const std::uint64_t kind = number_at(head, kKindBytes);
    const std::uint64_t content_bytes = number_at(head.subspan(kKindBytes), kLengthBytes);
    if (!is_known(kind)) {
        return decode_error(place(offset) + "its kind is unknown: " + std::to_string(kind));
    }
    if (content_bytes > kMaxRecordBytes || content_bytes > file_bytes - offset - bytes.size()) {
        return decode_error(place(offset) + std::to_string(content_bytes) + " bytes announced, but the file has only " +
                            std::to_string(file_bytes - offset - bytes.size()));
    }
    return RecordHead{.kind = static_cast<RecordKind>(kind),
                      .content_bytes = static_cast<std::uint32_t>(content_bytes),
                      .crc32c =
                          static_cast<std::uint32_t>(number_at(head.subspan(kKindBytes + kLengthBytes), kCrcBytes)),
                      .head_crc32c = codec::crc32c(head.first(kKindBytes + kLengthBytes))};
}

Decoded<Bytes> read_content(std::istream& file, std::uint64_t offset, const RecordHead& head) {
    Bytes content(head.content_bytes);
    if (!content.empty() && !read_bytes(file, offset + kRecordHeadBytes, content)) {
        return decode_error(place(offset) + "it cannot be read");
    }
    return content;
}

Decoded<Bytes> read_record(std::istream& file, std::uint64_t offset, std::uint64_t file_bytes, RecordKind kind) {
    const auto head = read_head(file, offset, file_bytes);
    if (!head) {
        return tl::unexpected(head.error());
    }
    if (head->kind != kind) {
        return decode_error(place(offset) + "its kind is " + std::to_string(static_cast<std::uint32_t>(head->kind)) +
                            " instead of " + std::to_string(static_cast<std::uint32_t>(kind)));
    }
    auto content = read_content(file, offset, *head);
    if (content && codec::crc32c(*content, head->head_crc32c) != head->crc32c) {
        return decode_error(place(offset) + "its CRC is wrong");
    }
    return content;
}

} // namespace fieldcast::recording
