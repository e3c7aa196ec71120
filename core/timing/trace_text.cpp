// SPDX-License-Identifier: Apache-2.0
#include "core/timing/trace_text.h"

#include "core/base/json_text.h"

#include <array>
#include <cstdio>
#include <utility>

namespace fieldcast::timing {

namespace {

constexpr std::uint64_t kFirstClientProcess = 1000; ///< process of client n: this + n; channels come before
constexpr std::size_t kMaxNamedClients = 4096;

/// Nanoseconds as the microseconds of the format.
std::string microseconds(std::int64_t time_ns) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%lld.%03lld", static_cast<long long>(time_ns / 1000),
                  static_cast<long long>(time_ns % 1000));
    return text.data();
}

std::string metadata(const char* what, std::uint64_t process, int track, const std::string& name) {
    return std::string(R"({"ph":"M","name":")") + what + R"(","pid":)" + std::to_string(process) + R"(,"tid":)" +
           std::to_string(track) + R"(,"args":{"name":)" + json_text(name) + "}}";
}

} // namespace

void TraceText::add(const std::string& event) {
    text_ += has_events_ ? ",\n" : "";
    text_ += event;
    has_events_ = true;
}

void TraceText::name_process(std::uint64_t process, const std::string& name) {
    add(metadata("process_name", process, 0, name));
}

TraceText::Channel& TraceText::channel(const std::string& name) {
    const auto [found, is_new] = channels_.try_emplace(name);
    if (is_new) {
        found->second.process = static_cast<int>(channels_.size());
        name_process(static_cast<std::uint64_t>(found->second.process), "channel " + name);
    }
    return found->second;
}

int TraceText::track(Channel& channel, std::string_view name) {
    const auto found = channel.tracks.find(name);
    if (found != channel.tracks.end()) {
        return found->second;
    }
    const int track = static_cast<int>(channel.tracks.size()) + 1;
    channel.tracks.emplace(name, track);
    add(metadata("thread_name", static_cast<std::uint64_t>(channel.process), track, std::string(name)));
    return track;
}

void TraceText::add_slice(Channel& channel, const Span& span, std::uint64_t frame_id) {
    if (span.begin_ns <= 0 || span.end_ns < span.begin_ns) {
        return;
    }
    const int own_track = track(channel, span.name);
    add(R"({"ph":"X","name":)" + json_text(span.name) + R"(,"cat":"channel","ts":)" + microseconds(span.begin_ns) +
        R"(,"dur":)" + microseconds(span.end_ns - span.begin_ns) + R"(,"pid":)" + std::to_string(channel.process) +
        R"(,"tid":)" + std::to_string(own_track) + R"(,"args":{"frame":)" + std::to_string(frame_id) + "}}");
}

std::string TraceText::events_of(const MadeFrame& frame) {
    Channel& own = channel(frame.channel);
    add_slice(own, {"pose", frame.pose_sampled_ns, frame.render_begin_ns}, frame.frame_id);
    add_slice(own, {"render", frame.render_begin_ns, frame.render_end_ns}, frame.frame_id);
    std::int64_t begin_ns = frame.render_begin_ns;
    for (const StageTime& time : frame.stages) {
        const std::int64_t end_ns = begin_ns + static_cast<std::int64_t>(time.ms * 1e6);
        const std::string name = "device: " + time.stage;
        add_slice(own, {name, begin_ns, end_ns}, frame.frame_id);
        begin_ns = end_ns;
    }
    add_slice(own, {"encode", frame.encode_begin_ns, frame.encode_end_ns}, frame.frame_id);
    return std::exchange(text_, {});
}

void TraceText::add_step(const DeliveredFrame& frame, const Span& span) {
    if (span.begin_ns <= 0 || span.end_ns < span.begin_ns) {
        return;
    }
    const std::string shared = R"(,"name":)" + json_text(span.name) + R"(,"cat":"client","pid":)" +
                               std::to_string(kFirstClientProcess + frame.client) + R"(,"tid":1,"id":"c)" +
                               std::to_string(frame.client) + "e" + std::to_string(frame.epoch) + "f" +
                               std::to_string(frame.made.frame_id) + R"(","ts":)";
    add(R"({"ph":"b")" + shared + microseconds(span.begin_ns) + R"(,"args":{"frame":)" +
        std::to_string(frame.made.frame_id) + R"(,"epoch":)" + std::to_string(frame.epoch) + R"(,"bytes":)" +
        std::to_string(frame.payload_bytes) + R"(,"outcome":)" + json_text(to_text(frame.outcome)) + "}}");
    add(R"({"ph":"e")" + shared + microseconds(span.end_ns) + "}");
}

std::string TraceText::events_of(const DeliveredFrame& frame) {
    if (clients_.size() >= kMaxNamedClients) {
        clients_.clear(); // naming one again does no harm
    }
    if (clients_.insert(frame.client).second) {
        name_process(kFirstClientProcess + frame.client, "client " + std::to_string(frame.client));
    }
    const std::int64_t made_ns = frame.rendered_ns != 0 ? frame.rendered_ns : frame.decoded_ns;
    add_step(frame, {"wait for sending", frame.made.encode_end_ns, frame.send_begin_ns});
    add_step(frame, {"send", frame.send_begin_ns, frame.send_end_ns});
    add_step(frame, {"travel", frame.send_begin_ns, frame.last_byte_ns});
    add_step(frame, {"decode", frame.last_byte_ns, frame.decoded_ns});
    add_step(frame, {"make views", frame.decoded_ns, frame.rendered_ns});
    add_step(frame, {"show", made_ns, frame.shown_ns});
    return std::exchange(text_, {});
}

} // namespace fieldcast::timing
