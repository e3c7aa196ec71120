// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recording_writer.h"

#include "core/base/log.h"
#include "core/codec/crc32c.h"
#include "server/recording/channel_facts.h"

#include <algorithm>

namespace fieldcast::recording {

RecordingWriter::RecordingWriter(const std::filesystem::path& file, const feed::ChannelInfo& info)
    : path_(file), file_(file, std::ios::binary | std::ios::trunc), recorded_(info.recorded) {
    FC_ASSERT(!recorded_.empty(), "a recording must have at least one selection");
    for (const feed::Selection& selection : recorded_) {
        feed::add(demand_, selection);
    }
    if (!file_) {
        throw UserError(file.string() + ": cannot be written");
    }
    file_.write(kMagic.data(), static_cast<std::streamsize>(kMagic.size()));
    const Bytes channel = to_bytes(info);
    const Piece facts{.bytes = channel, .crc32c = codec::crc32c(channel)};
    write_record(file_, RecordKind::kChannel, {&facts, 1});
    if (info.bundle != nullptr && !demand_.planes.empty()) {
        const Piece bundle{.bytes = *info.bundle, .crc32c = codec::crc32c(*info.bundle)};
        write_record(file_, RecordKind::kScene, {&bundle, 1});
    }
    flush("its beginning");
}

RecordingWriter::~RecordingWriter() {
    try {
        finish();
    } catch (const std::exception& problem) {
        log::error("recording not finished", {{"file", path_.string()}, {"problem", problem.what()}});
    }
}

bool RecordingWriter::can_hold(const feed::EncodedFrame& frame) const {
    return std::ranges::all_of(recorded_, [&](const feed::Selection& selection) {
        return feed::covers(frame, selection) && feed::stands_alone(frame, selection);
    });
}

bool RecordingWriter::add(const feed::EncodedFrame& frame, std::chrono::nanoseconds at) {
    if (is_finished_ || !can_hold(frame)) {
        return false;
    }
    FrameMark mark{.frame_id = frame.header.frame_id, .key_frame_id = frame.key_frame_id};
    if (mark.is_key()) {
        last_key_id_ = mark.frame_id;
    } else if (mark.key_frame_id != last_key_id_) {
        mark.key_frame_id = 0; // that key frame is not in the file: keep only strips that stand alone
    }
    begin_ = frames_.empty() ? at : begin_;
    mark.at_ns = frames_.empty() ? 0 : std::max((at - begin_).count(), frames_.back().mark.at_ns);
    const FrameRecord record = to_record(frame, mark, demand_);
    const std::uint64_t offset = file_bytes_;
    write_record(file_, RecordKind::kFrame, record.pieces);
    flush("a frame");
    frames_.push_back({.mark = mark, .offset = offset});
    return true;
}

void RecordingWriter::finish() {
    if (is_finished_) {
        return;
    }
    is_finished_ = true;
    write_index(file_, file_bytes_, frames_);
    flush("its index");
    file_.close();
}

// Called after each record, so that no complete frame is lost if the process is killed.
void RecordingWriter::flush(const char* what) {
    file_.flush();
    if (!file_) {
        is_finished_ = true; // nothing behind an incomplete record could be read
        throw std::runtime_error(path_.string() + ": " + what + " could not be written; is the disk full?");
    }
    file_bytes_ = static_cast<std::uint64_t>(file_.tellp());
}

} // namespace fieldcast::recording
