// SPDX-License-Identifier: Apache-2.0
// The first byte of an input says what the rest is: 0, a file as it is; otherwise records, each a byte for its kind
// and a piece for its content. These get the heads and CRCs that belong to them, or nothing that is damaged would ever
// be looked at; if the byte is odd, the file ends with an index of its frames.
#include "server/recording/recording.h"

#include "core/base/error.h"
#include "core/codec/crc32c.h"
#include "tests/fuzz/input.h"

#include <sstream>

namespace fieldcast::fuzz {

namespace {

using recording::RecordKind;

void append_record(std::ostream& file, RecordKind kind, Bytes content) {
    const recording::Piece piece{.bytes = content, .crc32c = codec::crc32c(content)};
    recording::write_record(file, kind, {&piece, 1});
}

std::string file_of_records(Reader reader, bool has_index) {
    std::ostringstream file;
    file << recording::kMagic;
    std::vector<recording::IndexEntry> frames;
    while (!reader.is_empty()) {
        const auto kind = static_cast<RecordKind>(reader.take_byte());
        const Bytes content = reader.take_piece();
        const auto mark = recording::mark_from_bytes(content);
        if (kind == RecordKind::kFrame && mark) {
            frames.push_back({.mark = *mark, .offset = static_cast<std::uint64_t>(file.tellp())});
        }
        append_record(file, kind, content);
    }
    if (has_index) {
        recording::write_index(file, static_cast<std::uint64_t>(file.tellp()), frames);
    }
    return file.str();
}

/// What was read can be recorded again, and is read as the same frame.
void expect_round_trip(const feed::EncodedFrame& frame, const recording::FrameMark& mark, const feed::Demand& demand) {
    recording::FrameMark again = mark;
    again.key_frame_id = frame.key_frame_id;
    const recording::FrameRecord record = recording::to_record(frame, again, demand);
    std::stringstream file;
    recording::write_record(file, RecordKind::kFrame, record.pieces);
    const std::uint64_t file_bytes = file.str().size();
    const auto head = recording::read_head(file, 0, file_bytes);
    FC_ASSERT(head.has_value(), "a head that we wrote is read");
    auto content = recording::read_content(file, 0, *head);
    FC_ASSERT(content.has_value(), "a content that we wrote is read");
    const auto read = recording::frame_from_content({.head = *head, .bytes = std::move(*content)}, demand);
    FC_ASSERT(read && read->header == frame.header && read->key_frame_id == frame.key_frame_id,
              "a frame survives writing and reading");
}

void read_everything(const std::filesystem::path& file) {
    recording::Recording recording(file);
    feed::Demand demand;
    for (const feed::Selection& selection : recording.info().recorded) {
        feed::add(demand, selection);
    }
    for (std::size_t i = 0; i < recording.frames().size(); ++i) {
        if (const auto frame = recording.read(i)) {
            expect_round_trip(*frame, recording.frames()[i].mark, demand);
        } else {
            FC_ASSERT(!frame.error().message.empty(), "an error says what is wrong");
        }
    }
}

} // namespace

void recording(Bytes input) {
    Reader reader(input);
    const std::uint8_t shape = reader.take_byte();
    const std::string made = shape == 0 ? std::string() : file_of_records(reader, shape % 2 == 1);
    const auto file = scratch_file("a.fcrec", shape == 0 ? reader.rest() : std::as_bytes(std::span(made)));
    static_cast<void>(is_refused([&] { read_everything(file); }));
}

} // namespace fieldcast::fuzz
