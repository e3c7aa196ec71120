// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fieldcast::bench::fanout {

/// The messages of some frames as they stood on the wire, to be streamed again and again.
struct MessageLoop {
    using Frame = std::vector<std::string>;
    std::vector<Frame> frames;

    std::uint64_t bytes() const;
    std::size_t message_count() const;
    bool operator==(const MessageLoop&) const = default;
};

/// For another process on this machine: u64 count of frames; of each, u64 count of messages; of each, u64 length and
/// bytes. Throws UserError if the file cannot be written.
void write_messages(const std::filesystem::path& file, const MessageLoop& loop);

/// Throws UserError if the file is none of these.
MessageLoop read_messages(const std::filesystem::path& file);

} // namespace fieldcast::bench::fanout
