// SPDX-License-Identifier: Apache-2.0
#include "core/timing/log_text.h"

#include "core/base/json_text.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace fieldcast::timing {

namespace {

struct TimeColumn {
    const char* name;
    std::int64_t (*value)(const DeliveredFrame&);
};

constexpr std::array kTimes{
    TimeColumn{"pose_sampled_ns", [](const DeliveredFrame& f) { return f.made.pose_sampled_ns; }},
    TimeColumn{"render_begin_ns", [](const DeliveredFrame& f) { return f.made.render_begin_ns; }},
    TimeColumn{"render_end_ns", [](const DeliveredFrame& f) { return f.made.render_end_ns; }},
    TimeColumn{"encode_begin_ns", [](const DeliveredFrame& f) { return f.made.encode_begin_ns; }},
    TimeColumn{"encode_end_ns", [](const DeliveredFrame& f) { return f.made.encode_end_ns; }},
    TimeColumn{"send_begin_ns", [](const DeliveredFrame& f) { return f.send_begin_ns; }},
    TimeColumn{"send_end_ns", [](const DeliveredFrame& f) { return f.send_end_ns; }},
    TimeColumn{"first_byte_ns", [](const DeliveredFrame& f) { return f.first_byte_ns; }},
    TimeColumn{"last_byte_ns", [](const DeliveredFrame& f) { return f.last_byte_ns; }},
    TimeColumn{"decoded_ns", [](const DeliveredFrame& f) { return f.decoded_ns; }},
    TimeColumn{"rendered_ns", [](const DeliveredFrame& f) { return f.rendered_ns; }},
    TimeColumn{"shown_ns", [](const DeliveredFrame& f) { return f.shown_ns; }},
    TimeColumn{"clock_round_trip_ns", [](const DeliveredFrame& f) { return f.clock_round_trip_ns; }},
};

std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4f", value);
    return text.data();
}

std::string known(std::int64_t time_ns, const char* unknown) {
    return time_ns == 0 ? unknown : std::to_string(time_ns);
}

/// A field of RFC 4180: in quotes, with its own quotes doubled.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        result += c == '"' ? "\"\"" : std::string(1, c);
    }
    return result + '"';
}

} // namespace

std::string csv_header() {
    std::string line = "channel,client,frame,epoch,outcome,scene_time_ns,payload_bytes";
    for (const TimeColumn& column : kTimes) {
        line += std::string(",") + column.name;
    }
    return line + ",stages\n";
}

std::string to_csv(const DeliveredFrame& frame) {
    std::string line = quoted(frame.made.channel) + ',' + std::to_string(frame.client) + ',' +
                       std::to_string(frame.made.frame_id) + ',' + std::to_string(frame.epoch) + ',' +
                       std::string(to_text(frame.outcome)) + ',' + std::to_string(frame.made.scene_time_ns) + ',' +
                       std::to_string(frame.payload_bytes);
    for (const TimeColumn& column : kTimes) {
        line += ',' + known(column.value(frame), "");
    }
    std::string stages;
    for (const StageTime& time : frame.made.stages) {
        stages += stages.empty() ? "" : ";";
        stages += time.stage + '=' + number(time.ms);
    }
    return line + ',' + quoted(stages) + '\n';
}

std::string to_json_line(const DeliveredFrame& frame) {
    std::string line = "{\"channel\":" + json_text(frame.made.channel) + ",\"client\":" + std::to_string(frame.client) +
                       ",\"frame\":" + std::to_string(frame.made.frame_id) +
                       ",\"epoch\":" + std::to_string(frame.epoch) +
                       ",\"outcome\":" + json_text(to_text(frame.outcome)) +
                       ",\"scene_time_ns\":" + std::to_string(frame.made.scene_time_ns) +
                       ",\"payload_bytes\":" + std::to_string(frame.payload_bytes);
    for (const TimeColumn& column : kTimes) {
        line += std::string(",\"") + column.name + "\":" + known(column.value(frame), "null");
    }
    std::string stages;
    for (const StageTime& time : frame.made.stages) {
        stages += stages.empty() ? "" : ",";
        stages += json_text(time.stage) + ':' + number(time.ms);
    }
    return line + ",\"stages\":{" + stages + "}}\n";
}

} // namespace fieldcast::timing
