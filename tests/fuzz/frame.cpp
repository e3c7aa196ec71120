// SPDX-License-Identifier: Apache-2.0
// An input is a row of pieces, each a FrameChunk. Checksums are put right, or nothing that is damaged would ever be
// decoded to the end.
#include "core/wire/convert.h"
#include "tests/fuzz/received_chunks.h"

namespace fieldcast::fuzz {

namespace {

constexpr std::uint64_t kMaxFrameBytes = 4U << 20;

/// What was accepted once is accepted again after we have written it, and stays the same.
void expect_round_trip(const v1::FrameChunk& chunk) {
    if (!chunk.has_header()) {
        return;
    }
    const auto header = wire::from_proto(chunk.header(), chunk.frame_id());
    if (!header) {
        FC_ASSERT(!header.error().message.empty(), "an error says what is wrong");
        return;
    }
    v1::FrameHeader written;
    wire::to_proto(*header, written);
    const auto again = wire::from_proto(written, chunk.frame_id());
    FC_ASSERT(again && *again == *header, "a header survives writing and reading");
}

} // namespace

void frame(Bytes input) {
    for (const wire::Decoding decoding : {wire::Decoding::kFull, wire::Decoding::kChecksum, wire::Decoding::kHeaders}) {
        ReceivedChunks chunks(decoding);
        bool has_epoch = false;
        for (Reader reader(input); !reader.is_empty();) {
            v1::FrameChunk chunk;
            const Bytes piece = reader.take_piece();
            if (!chunk.ParseFromArray(piece.data(), static_cast<int>(piece.size()))) {
                continue;
            }
            if (!has_epoch) {
                chunks.begin_epoch(chunk.epoch(), {.max_frame_bytes = kMaxFrameBytes});
                has_epoch = true;
            }
            expect_round_trip(chunk);
            chunks.add(std::move(chunk));
        }
    }
}

} // namespace fieldcast::fuzz
