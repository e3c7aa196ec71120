// SPDX-License-Identifier: Apache-2.0
#include "core/wire/frame_assembler.h"

#include "core/codec/crc32c.h"
#include "core/codec/plane_codec.h"
#include "core/wire/base_view.h"
#include "core/wire/convert.h"
#include "core/wire/frame_parts.h"

#include <algorithm>
#include <string>
#include <utility>

namespace fieldcast::wire {

namespace {

using Clock = std::chrono::steady_clock;

struct Strip {
    std::uint32_t part = 0;
    codec::RowBand band;
    std::uint32_t size = 0;     ///< announced bytes
    std::uint32_t received = 0; ///< bytes so far
    std::string bytes;          ///< received bytes; stays empty without Decoding::kFull
};

std::span<const std::byte> as_bytes(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string frame_name(std::uint64_t frame_id) {
    return "frame " + std::to_string(frame_id);
}

} // namespace

/// A frame in progress.
struct FrameAssembler::Frame {
    FrameHeader header;
    std::optional<ViewSet> set; ///< of a frame of views
    std::vector<Part> parts;
    std::uint64_t key_frame_id = 0;                 ///< as in the header
    const std::vector<Plane>* key_planes = nullptr; ///< to which strips may refer; null: none
    Decoding decoding = Decoding::kFull;
    std::uint32_t next_index = 1;
    std::optional<Strip> open;    ///< strip with missing slices
    std::vector<Strip> undecoded; ///< complete strips
    std::optional<std::uint32_t> base_part; ///< index of the base view; empty: views are not predicted from each other
    BaseStrips base_strips;
    std::uint32_t crc32c = 0;
    std::uint64_t payload_bytes = 0;
    std::chrono::nanoseconds decode_time{0};

    static Decoded<std::unique_ptr<Frame>> begin(const v1::FrameChunk& chunk, const FrameLimits& limits);
    Decoded<void> refer_to(const std::vector<Plane>& planes);
    Decoded<void> add_slice(v1::FrameChunk& chunk);
    void keep_payload(v1::FrameChunk& chunk);
    Decoded<void> open_strip(const v1::StripSlice& slice);
    Decoded<void> decode_strips(WorkerPool* pool);
    Decoded<void> check_complete(const v1::FrameTrailer& trailer) const;
    Decoded<ReceivedFrame> finish(const v1::FrameTrailer& trailer, std::uint32_t epoch);
};

Decoded<std::unique_ptr<FrameAssembler::Frame>> FrameAssembler::Frame::begin(const v1::FrameChunk& chunk,
                                                                             const FrameLimits& limits) {
    auto header = from_proto(chunk.header(), chunk.frame_id());
    if (!header) {
        return tl::unexpected(header.error());
    }
    if (!chunk.payload().empty()) {
        return decode_error("header chunk with payload");
    }
    auto frame = std::make_unique<Frame>();
    frame->header = std::move(*header);
    frame->key_frame_id = chunk.header().key_frame_id();
    if (chunk.header().has_views()) {
        const auto set = from_proto(chunk.header().views().view_set());
        if (!set) {
            return tl::unexpected(set.error());
        }
        frame->set = *set;
    }
    auto parts = frame->set ? parts_of_views(chunk.header().views(), *frame->set, limits)
                            : parts_of_planes(chunk.header().planes(), frame->header, limits);
    if (!parts) {
        return tl::unexpected(parts.error());
    }
    frame->parts = std::move(*parts);
    if (frame->set && row_of(frame->parts.front().codec).predicts_views) {
        frame->base_part = wire::base_part(frame->set->grid);
    }
    return frame;
}

Decoded<void> FrameAssembler::Frame::refer_to(const std::vector<Plane>& planes) {
    const auto is_alike = [](const Part& part, const Plane& plane) { // sizes of residual planes may differ
        return part.semantic == plane.semantic && part.format == plane.format &&
               (is_residual(part.semantic) ||
                (part.width_px == plane.width_px && part.height_px == plane.height_px));
    };
    if (!std::ranges::equal(parts, planes, is_alike)) {
        return decode_error("header.key_frame_id: the key frame has other planes");
    }
    key_planes = &planes;
    return {};
}

Decoded<void> FrameAssembler::Frame::open_strip(const v1::StripSlice& slice) {
    if (slice.part() >= parts.size()) {
        return decode_error("strip.part: " + std::to_string(slice.part()) + ", the frame has " +
                            std::to_string(parts.size()));
    }
    Part& part = parts[slice.part()];
    if (slice.first_row() != part.next_row || slice.row_count() == 0 ||
        slice.row_count() > part.height_px - part.next_row) {
        return decode_error("strip: rows " + std::to_string(slice.first_row()) + " + " +
                            std::to_string(slice.row_count()) + " of part " + std::to_string(slice.part()) + ", row " +
                            std::to_string(part.next_row) + " of " + std::to_string(part.height_px) + " is next");
    }
    const std::uint64_t most = codec::max_strip_bytes(part.format, part.width_px, slice.row_count());
    if (slice.strip_bytes() < codec::kStripHeaderBytes || slice.strip_bytes() > most || slice.slice_offset() != 0) {
        return decode_error("strip: " + std::to_string(slice.strip_bytes()) + " bytes from offset " +
                            std::to_string(slice.slice_offset()) + ", at most " + std::to_string(most) + " from 0");
    }
    open = Strip{slice.part(), {slice.first_row(), slice.row_count()}, slice.strip_bytes(), 0, {}};
    return {};
}

Decoded<void> FrameAssembler::Frame::add_slice(v1::FrameChunk& chunk) {
    const v1::StripSlice& slice = chunk.strip();
    if (!open) {
        if (auto opened = open_strip(slice); !opened) {
            return opened;
        }
    }
    const codec::RowBand band{slice.first_row(), slice.row_count()};
    if (slice.part() != open->part || band != open->band || slice.strip_bytes() != open->size ||
        slice.slice_offset() != open->received) {
        return decode_error("strip: slice does not continue the previous slice");
    }
    const std::string& payload = chunk.payload();
    if (payload.empty() || payload.size() > open->size - open->received) {
        return decode_error("strip: payload of " + std::to_string(payload.size()) + " bytes, " +
                            std::to_string(open->size - open->received) + " are missing");
    }
    keep_payload(chunk);
    if (open->received == open->size) {
        parts[open->part].next_row += open->band.row_count;
        if (decoding == Decoding::kFull) {
            if (open->part == base_part) {
                base_strips.keep(open->band, as_bytes(open->bytes));
            }
            undecoded.push_back(std::move(*open));
        }
        open.reset();
    }
    return {};
}

/// Counts the payload and adds it to the CRC; keeps it for decoding with Decoding::kFull.
void FrameAssembler::Frame::keep_payload(v1::FrameChunk& chunk) {
    const std::string& payload = chunk.payload();
    open->received += static_cast<std::uint32_t>(payload.size());
    payload_bytes += payload.size();
    if (decoding != Decoding::kHeaders) {
        crc32c = codec::crc32c(as_bytes(payload), crc32c);
    }
    if (decoding != Decoding::kFull) {
        return;
    }
    if (open->bytes.empty()) {
        open->bytes = std::move(*chunk.mutable_payload()); // usually the whole strip, so nothing is copied
    } else {
        open->bytes += payload;
    }
}

Decoded<void> FrameAssembler::Frame::decode_strips(WorkerPool* pool) {
    for (const Strip& strip : undecoded) { // before strips are decoded in parallel: they share the memory of their part
        Part& part = parts[strip.part];
        if (part.plane.bytes.empty()) {
            auto plane = codec::allocate_plane(part.semantic, part.format, part.width_px, part.height_px);
            if (!plane) {
                return tl::unexpected(plane.error());
            }
            part.plane = std::move(*plane);
        }
    }
    std::vector<Decoded<void>> results(undecoded.size());
    const auto decode_one = [&](std::size_t i) {
        const Strip& strip = undecoded[i];
        Part& part = parts[strip.part];
        const bool has_reference = key_planes != nullptr && !is_residual(part.semantic);
        const Plane* reference = has_reference ? &(*key_planes)[strip.part] : nullptr;
        results[i] = codec::decode_strip(as_bytes(strip.bytes), strip.band,
                                         {part.codec, reference, base_strips.find(strip.band)}, part.plane);
    };
    if (pool != nullptr) {
        pool->for_each(undecoded.size(), decode_one);
    } else {
        for (std::size_t i = 0; i < undecoded.size(); ++i) {
            decode_one(i);
        }
    }
    undecoded.clear();
    const auto failed = std::ranges::find_if(results, [](const auto& result) { return !result.has_value(); });
    return failed == results.end() ? Decoded<void>{} : *failed;
}

Decoded<void> FrameAssembler::Frame::check_complete(const v1::FrameTrailer& trailer) const {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].next_row != parts[i].height_px) {
            return decode_error("trailer: part " + std::to_string(i) + " ends at row " +
                                std::to_string(parts[i].next_row) + " of " + std::to_string(parts[i].height_px));
        }
    }
    if (decoding != Decoding::kHeaders && trailer.crc32c() != crc32c) {
        return decode_error("trailer.crc32c: payload was damaged");
    }
    return {};
}

Decoded<ReceivedFrame> FrameAssembler::Frame::finish(const v1::FrameTrailer& trailer, std::uint32_t epoch) {
    ReceivedFrame received;
    received.epoch = epoch;
    received.server_times = from_proto(trailer.times());
    received.payload_bytes = payload_bytes;
    if (!set) {
        SourceFrame source{std::move(header), {}};
        for (Part& part : parts) {
            source.planes.push_back(std::move(part.plane));
        }
        received.content = std::move(source);
        return received;
    }
    const auto discards = discards_from_proto(trailer, *set);
    if (!discards) {
        return tl::unexpected(discards.error());
    }
    ReceivedViews views{*set, {std::move(header), {}}};
    const auto positions = lattice_positions(set->grid);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        views.views.views.push_back({positions[i], std::move(parts[i].plane), (*discards)[i]});
    }
    received.content = std::move(views);
    return received;
}

const FrameHeader& ReceivedFrame::header() const {
    const auto* views = std::get_if<ReceivedViews>(&content);
    return views != nullptr ? views->views.header : std::get<SourceFrame>(content).header;
}

FrameAssembler::FrameAssembler(WorkerPool* pool, Decoding decoding) : pool_(pool), decoding_(decoding) {}

FrameAssembler::~FrameAssembler() = default;

void FrameAssembler::begin_epoch(std::uint32_t epoch, const FrameLimits& limits) {
    epoch_ = epoch;
    limits_ = limits;
    frame_.reset();
    key_.reset();
    last_frame_id_.reset();
    skipped_id_.reset();
}

void FrameAssembler::abort(std::uint64_t frame_id) {
    skipped_id_ = frame_id;
    if (frame_ && frame_->header.frame_id == frame_id) {
        frame_.reset();
    }
}

Decoded<std::optional<ReceivedFrame>> FrameAssembler::add(v1::FrameChunk chunk) {
    if (skipped_id_ == chunk.frame_id()) {
        return std::nullopt;
    }
    auto added = add_to_frame(chunk);
    if (!added) {
        skipped_id_ = chunk.frame_id();
        frame_.reset();
        return decode_error(frame_name(chunk.frame_id()) + ": " + added.error().message);
    }
    if (*added) {
        frame_.reset();
    }
    return added;
}

Decoded<std::optional<ReceivedFrame>> FrameAssembler::add_to_frame(v1::FrameChunk& chunk) {
    const auto begin = Clock::now();
    if (auto checked = check_order(chunk); !checked) {
        return tl::unexpected(checked.error());
    }
    if (chunk.has_header()) {
        if (auto begun = begin_frame(chunk); !begun) {
            return tl::unexpected(begun.error());
        }
        return std::nullopt;
    }
    ++frame_->next_index;
    if (chunk.has_strip()) {
        if (auto added = frame_->add_slice(chunk); !added) {
            return tl::unexpected(added.error());
        }
    }
    const std::size_t batch = pool_ != nullptr ? pool_->thread_count() : 1;
    if (chunk.has_trailer() || frame_->undecoded.size() >= batch) {
        if (auto decoded = frame_->decode_strips(pool_); !decoded) {
            return tl::unexpected(decoded.error());
        }
    }
    frame_->decode_time += Clock::now() - begin;
    if (!chunk.has_trailer()) {
        return std::nullopt;
    }
    if (auto checked = frame_->check_complete(chunk.trailer()); !checked) {
        return tl::unexpected(checked.error());
    }
    keep_key_frame();
    auto received = frame_->finish(chunk.trailer(), epoch_);
    if (!received) {
        return tl::unexpected(received.error());
    }
    received->decode_time = frame_->decode_time;
    return std::move(*received);
}

Decoded<void> FrameAssembler::begin_frame(const v1::FrameChunk& chunk) {
    last_frame_id_ = chunk.frame_id();
    auto frame = Frame::begin(chunk, limits_);
    if (!frame) {
        return tl::unexpected(frame.error());
    }
    (*frame)->decoding = decoding_;
    if (decoding_ != Decoding::kFull) {
        for (Part& part : (*frame)->parts) { // planes with semantic, format and size, but without pixels
            part.plane = {part.semantic, part.format, part.width_px, part.height_px, {}};
        }
    }
    const std::uint64_t key_frame_id = (*frame)->key_frame_id;
    if (key_frame_id != 0 && key_frame_id != chunk.frame_id()) {
        if (!key_ || key_->frame_id != key_frame_id) {
            return decode_error("header.key_frame_id: " + std::to_string(key_frame_id) + " is not the last key frame" +
                                (key_ ? ", " + std::to_string(key_->frame_id) + " is" : ": there is none"));
        }
        if (auto refers = (*frame)->refer_to(key_->planes); !refers) {
            return refers;
        }
    }
    frame_ = std::move(*frame);
    return {};
}

void FrameAssembler::keep_key_frame() {
    if (frame_->key_frame_id != frame_->header.frame_id) {
        return;
    }
    key_ = Key{frame_->key_frame_id, {}};
    for (const Part& part : frame_->parts) {
        key_->planes.push_back(part.plane);
    }
}

Decoded<void> FrameAssembler::check_order(const v1::FrameChunk& chunk) const {
    if (epoch_ == 0 || chunk.epoch() != epoch_) {
        return decode_error("epoch " + std::to_string(chunk.epoch()) + " instead of " + std::to_string(epoch_));
    }
    if (chunk.payload().size() > limits_.max_chunk_bytes) {
        return decode_error("payload of " + std::to_string(chunk.payload().size()) + " bytes, at most " +
                            std::to_string(limits_.max_chunk_bytes));
    }
    if (chunk.has_header()) {
        if (frame_) {
            return decode_error("begins before " + frame_name(frame_->header.frame_id) + " was completed");
        }
        if (last_frame_id_ && chunk.frame_id() <= *last_frame_id_) {
            return decode_error("frame ids must grow, the previous one was " + std::to_string(*last_frame_id_));
        }
        return chunk.index() == 0 ? Decoded<void>{} : decode_error("header chunk with index above 0");
    }
    if (!frame_ || chunk.frame_id() != frame_->header.frame_id) {
        return decode_error("chunk of a frame without header");
    }
    if (chunk.index() != frame_->next_index) {
        return decode_error("chunk " + std::to_string(chunk.index()) + " instead of " +
                            std::to_string(frame_->next_index));
    }
    if (!chunk.has_strip() && (!chunk.has_trailer() || !chunk.payload().empty())) {
        return decode_error("neither header, strip nor trailer, or a trailer with payload");
    }
    return {};
}

} // namespace fieldcast::wire
