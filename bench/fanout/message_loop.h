// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fieldcast::bench::fanout {

/// The messages of some frames as received, to be streamed repeatedly.
struct MessageLoop {
    using Frame = std::vector<std::string>;
    std::vector<Frame> frames;

    std::uint64_t bytes() const;
    std::size_t message_count() const;
    bool operator==(const MessageLoop&) const = default;
};

/// Writes the messages for another process on this machine: u64 number of frames; per frame, u64 number of messages;
/// per message, u64 length and bytes. Throws UserError if the file cannot be written.
void write_messages(const std::filesystem::path& file, const MessageLoop& loop);

/// Reads such a file. Throws UserError if it is malformed.
MessageLoop read_messages(const std::filesystem::path& file);

} // namespace fieldcast::bench::fanout
