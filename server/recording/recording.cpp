// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recording.h"

#include "server/recording/channel_facts.h"

namespace fieldcast::recording {

namespace {

constexpr std::uint64_t kMaxChannelBytes = 1 << 20;

} // namespace

Recording::Recording(const std::filesystem::path& file) : path_(file), file_(file, std::ios::binary) {
    std::error_code error;
    file_bytes_ = std::filesystem::file_size(file, error);
    if (error || !file_) {
        throw UserError(file.string() + ": cannot be read");
    }
    std::string magic(kMagic.size(), '\0');
    file_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (!file_ || !magic.starts_with(kMagic.substr(0, kMagic.size() - 1))) {
        throw UserError(file.string() + ": it is not a recording");
    }
    if (magic != kMagic) {
        throw UserError(file.string() + ": its format has version " + std::to_string(static_cast<int>(magic.back())) +
                        ", but this program reads version 1");
    }
    read_channel();
    read_index_or_scan();
}

void Recording::read_channel() {
    const auto refuse = [&](const DecodeError& problem) -> UserError {
        return UserError(path_.string() + ": " + problem.message);
    };
    const auto head = read_head(file_, kMagic.size(), file_bytes_);
    if (head && head->content_bytes > kMaxChannelBytes) {
        throw refuse({"channel: " + std::to_string(head->content_bytes) + " bytes, at most 1 MiB"});
    }
    const auto bytes = read_record(file_, kMagic.size(), file_bytes_, RecordKind::kChannel);
    auto info = bytes ? channel_from_bytes(*bytes) : tl::unexpected(bytes.error());
    if (!info) {
        throw refuse(info.error());
    }
    info_ = std::move(*info);
    for (const feed::Selection& selection : info_.recorded) {
        feed::add(demand_, selection);
    }
    frames_begin_ = kMagic.size() + kRecordHeadBytes + bytes->size();
    const auto next = read_head(file_, frames_begin_, file_bytes_);
    if (next && next->kind == RecordKind::kScene) {
        auto bundle = read_record(file_, frames_begin_, file_bytes_, RecordKind::kScene);
        if (!bundle) {
            throw refuse(bundle.error());
        }
        frames_begin_ += kRecordHeadBytes + bundle->size();
        info_.bundle = std::make_shared<const Bytes>(std::move(*bundle));
    }
}

void Recording::read_index_or_scan() {
    if (auto index = read_index(file_, frames_begin_, file_bytes_)) {
        index_ = std::move(*index);
    } else {
        index_ = scan_frames(file_, frames_begin_, file_bytes_);
        const std::string why = index.error().message;
        index_.ignored = index_.ignored ? why + "; " + *index_.ignored : why;
    }
    if (index_.frames.empty()) {
        throw UserError(path_.string() + ": it has no complete frame" +
                        (index_.ignored ? " (" + *index_.ignored + ")" : std::string()));
    }
}

Decoded<feed::EncodedFrame> Recording::read(std::size_t i) {
    const IndexEntry& entry = index_.frames.at(i);
    const auto head = read_head(file_, entry.offset, file_bytes_);
    if (!head) {
        return tl::unexpected(head.error());
    }
    if (head->kind != RecordKind::kFrame) {
        return decode_error("record at byte " + std::to_string(entry.offset) + ": it is not a frame");
    }
    auto bytes = read_content(file_, entry.offset, *head);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    auto frame = frame_from_content({.head = *head, .bytes = std::move(*bytes)}, demand_);
    if (frame && (frame->header.frame_id != entry.mark.frame_id || frame->key_frame_id != entry.mark.key_frame_id)) {
        return decode_error("record at byte " + std::to_string(entry.offset) + ": its frame differs from the index");
    }
    return frame;
}

} // namespace fieldcast::recording
