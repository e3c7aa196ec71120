// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/readback.h"

#include "core/base/error.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace fieldcast::gpu {
namespace {

constexpr std::uint64_t kAlignment = 256; // of parts in the staging buffer, bytes

bool needs_copy(const ReadbackPart& part) {
    return !part.bytes.empty() && !part.buffer->is_cached();
}

std::uint64_t staging_bytes(const ReadbackPart& part) {
    return needs_copy(part) ? (part.bytes.size() + kAlignment - 1) / kAlignment * kAlignment : 0;
}

void check_bounds(const ReadbackPart& part) {
    const std::uint64_t size_bytes = part.buffer->size_bytes();
    FC_ASSERT(part.offset_bytes <= size_bytes && part.bytes.size() <= size_bytes - part.offset_bytes,
              "read past the end of a buffer");
}

} // namespace

void Readback::prepare(std::vector<ReadbackPart> parts) {
    parts_ = std::move(parts);
    std::uint64_t total_bytes = 0;
    for (const ReadbackPart& part : parts_) {
        check_bounds(part);
        total_bytes += staging_bytes(part);
    }
    make_room(*device_, staging_, total_bytes, Memory::kReadback);
}

void Readback::record_copies(CommandRecorder& recorder) const {
    std::uint64_t offset_bytes = 0;
    for (const ReadbackPart& part : parts_) {
        if (needs_copy(part)) {
            recorder.copy(*part.buffer, staging_, part.bytes.size(), part.offset_bytes, offset_bytes);
            offset_bytes += staging_bytes(part);
        }
    }
}

void Readback::record(CommandRecorder& recorder, std::vector<ReadbackPart> parts) {
    prepare(std::move(parts));
    record_copies(recorder);
}

void Readback::finish() {
    std::uint64_t offset_bytes = 0;
    for (const ReadbackPart& part : parts_) {
        if (part.bytes.empty()) {
            continue;
        }
        const std::byte* const from =
            needs_copy(part) ? staging_.mapped() + offset_bytes : part.buffer->mapped() + part.offset_bytes;
        std::memcpy(part.bytes.data(), from, part.bytes.size());
        offset_bytes += staging_bytes(part);
    }
    parts_.clear();
}

void Readback::read(std::vector<ReadbackPart> parts) {
    prepare(std::move(parts));
    if (std::ranges::any_of(parts_, needs_copy)) {
        if (recorder_ == nullptr) {
            recorder_ = std::make_unique<CommandRecorder>(*device_);
        }
        recorder_->barrier(); // earlier submissions wrote the parts
        record_copies(*recorder_);
        recorder_->submit();
    }
    finish();
}

} // namespace fieldcast::gpu
