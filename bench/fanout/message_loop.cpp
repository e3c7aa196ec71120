// SPDX-License-Identifier: Apache-2.0
#include "bench/fanout/message_loop.h"

#include "core/base/error.h"

#include <fstream>

namespace fieldcast::bench::fanout {

namespace {

constexpr std::uint64_t kMaxCount = 1 << 20;      ///< of frames, and of messages per frame
constexpr std::uint64_t kMaxMessageBytes = 4 << 20; ///< a chunk is at most 2 MiB

void write_number(std::ostream& file, std::uint64_t number) {
    file.write(reinterpret_cast<const char*>(&number), sizeof number);
}

std::uint64_t read_number(std::istream& file, std::uint64_t largest) {
    std::uint64_t number = 0;
    file.read(reinterpret_cast<char*>(&number), sizeof number);
    if (!file || number > largest) {
        throw UserError("a number is missing or too large");
    }
    return number;
}

std::string read_message(std::istream& file) {
    std::string message(read_number(file, kMaxMessageBytes), '\0');
    file.read(message.data(), static_cast<std::streamsize>(message.size()));
    if (!file) {
        throw UserError("a message is cut off");
    }
    return message;
}

} // namespace

std::uint64_t MessageLoop::bytes() const {
    std::uint64_t sum = 0;
    for (const Frame& frame : frames) {
        for (const std::string& message : frame) {
            sum += message.size();
        }
    }
    return sum;
}

std::size_t MessageLoop::message_count() const {
    std::size_t sum = 0;
    for (const Frame& frame : frames) {
        sum += frame.size();
    }
    return sum;
}

void write_messages(const std::filesystem::path& file, const MessageLoop& loop) {
    std::ofstream stream(file, std::ios::binary);
    write_number(stream, loop.frames.size());
    for (const MessageLoop::Frame& frame : loop.frames) {
        write_number(stream, frame.size());
        for (const std::string& message : frame) {
            write_number(stream, message.size());
            stream.write(message.data(), static_cast<std::streamsize>(message.size()));
        }
    }
    stream.flush();
    if (!stream) {
        throw UserError(file.string() + ": cannot be written");
    }
}

MessageLoop read_messages(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    MessageLoop loop;
    try {
        for (std::uint64_t frames = read_number(stream, kMaxCount); frames > 0; --frames) {
            MessageLoop::Frame& frame = loop.frames.emplace_back();
            for (std::uint64_t messages = read_number(stream, kMaxCount); messages > 0; --messages) {
                frame.push_back(read_message(stream));
            }
        }
    } catch (const UserError& problem) {
        throw UserError(file.string() + ": " + problem.what());
    }
    if (loop.frames.empty()) {
        throw UserError(file.string() + ": has no frames");
    }
    return loop;
}

} // namespace fieldcast::bench::fanout
