// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

// Records of a recording (docs/recordings.md): kind, length, CRC-32C, content. All integers are little-endian.
namespace fieldcast::recording {

inline constexpr std::string_view kMagic = "FCREC\r\n\x01"; ///< first bytes of a file; the last one is the version
inline constexpr std::string_view kEndMagic = "FCRECEND";   ///< last bytes of a file that was finished
inline constexpr std::size_t kRecordHeadBytes = 12;
inline constexpr std::uint64_t kMaxRecordBytes = 1ULL << 30;

/// Kind of a record. The values are stored in files: never renumber.
enum class RecordKind : std::uint32_t {
    kChannel = 1, ///< RecordedChannel; the first record
    kScene = 2,   ///< scene bundle; the second record, if planes were recorded
    kFrame = 3, ///< one frame
    kIndex = 4, ///< the last record
};

/// Head of a record.
struct RecordHead {
    RecordKind kind = RecordKind::kFrame;
    std::uint32_t content_bytes = 0;
    std::uint32_t crc32c = 0;        ///< of kind, length and content
    std::uint32_t head_crc32c = 0;   ///< of kind and length; continued with the content it gives `crc32c`
};

using Bytes = std::vector<std::byte>;

/// Appends the lowest `width` bytes of `value`.
void append_number(Bytes& bytes, std::uint64_t value, std::size_t width);

/// The number in the first `width` bytes; `bytes` must have as many.
std::uint64_t number_at(std::span<const std::byte> bytes, std::size_t width);

/// Part of a record's content, with its CRC.
struct Piece {
    std::span<const std::byte> bytes;
    std::uint32_t crc32c = 0;
};

/// Writes a record that consists of `pieces`. Throws UserError if they are more than kMaxRecordBytes.
void write_record(std::ostream& file, RecordKind kind, std::span<const Piece> pieces);

/// The head of the record at `offset` in a file of `file_bytes`; fails unless the content lies inside the file.
Decoded<RecordHead> read_head(std::istream& file, std::uint64_t offset, std::uint64_t file_bytes);

/// The content behind `head`; its CRC is not checked. Allocates head.content_bytes, which read_head has checked.
Decoded<Bytes> read_content(std::istream& file, std::uint64_t offset, const RecordHead& head);

/// The content of the record at `offset`; fails unless it has that kind and its CRC is right.
Decoded<Bytes> read_record(std::istream& file, std::uint64_t offset, std::uint64_t file_bytes, RecordKind kind);

} // namespace fieldcast::recording
