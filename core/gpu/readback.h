// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace fieldcast::gpu {

/// A part of a buffer, and the host memory that it is copied to.
struct ReadbackPart {
    const Buffer* buffer = nullptr;
    std::uint64_t offset_bytes = 0; ///< start of the part in `buffer`
    std::span<std::byte> bytes{};   ///< destination; its size is the size of the part
};

/// Copies parts of buffers to the host, all through one staging buffer. The staging buffer is kept for later calls and
/// grows when needed. Parts of buffers in cached host memory need no copy on the device. Not thread-safe.
///
///   readback.record(recorder, parts); // after a barrier
///   recorder.submit();
///   readback.finish();                // the destinations are filled
class Readback {
public:
    explicit Readback(const Device& device) : device_(&device) {}

    /// Records the copies into the staging buffer. Earlier writes to the parts must be visible
    /// (CommandRecorder::barrier()). Buffers and destinations must outlive finish(). Throws VulkanError if there is no
    /// memory for the staging buffer.
    void record(CommandRecorder& recorder, std::vector<ReadbackPart> parts);

    /// Fills the destinations of the last record(), whose recorder must have been submitted.
    void finish();

    /// Fills the destinations of `parts` with one submission at most. Blocks. Throws VulkanError.
    void read(std::vector<ReadbackPart> parts);

    /// Frees the staging buffer. Not between record() and finish().
    void forget() { staging_ = {}; }

private:
    void prepare(std::vector<ReadbackPart> parts);
    void record_copies(CommandRecorder& recorder) const;

    const Device* device_;
    std::vector<ReadbackPart> parts_; ///< of the last record()
    Buffer staging_;
    std::unique_ptr<CommandRecorder> recorder_; ///< of read(); null before its first copy
};

} // namespace fieldcast::gpu
