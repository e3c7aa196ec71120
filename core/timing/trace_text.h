// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/timing/frame_timing.h"

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace fieldcast::timing {

/// Frames as a JSON array of trace events, which ui.perfetto.dev and chrome://tracing open (Trace Event Format, Google,
/// 2016). A channel is a process with a track per stage: rendering, its stages on the device, encoding. A client is a
/// process with a track per step: sending, travelling, decoding, making views, waiting for the display; these overlap,
/// because several frames are under way, and are asynchronous events for that reason.
///
/// Stages on the device are known by their duration only; they are drawn one after the other from the beginning of
/// rendering on.
class TraceText {
public:
    static std::string begin() { return "[\n"; }
    static std::string end() { return "\n]\n"; }

    std::string events_of(const MadeFrame& frame);
    std::string events_of(const DeliveredFrame& frame); ///< of the client only

private:
    struct Span {
        std::string_view name;
        std::int64_t begin_ns = 0;
        std::int64_t end_ns = 0;
    };
    struct Channel {
        int process = 0;
        std::map<std::string, int, std::less<>> tracks;
    };
    void add(const std::string& event); ///< to `text_`
    Channel& channel(const std::string& name);
    int track(Channel& channel, std::string_view name);
    void name_process(std::uint64_t process, const std::string& name);
    void add_slice(Channel& channel, const Span& span, std::uint64_t frame_id);
    void add_step(const DeliveredFrame& frame, const Span& span);

    std::string text_; ///< events since the last call
    bool has_events_ = false;
    std::map<std::string, Channel> channels_;
    std::set<std::uint64_t> clients_; ///< already named; forgotten now and then
};

} // namespace fieldcast::timing
