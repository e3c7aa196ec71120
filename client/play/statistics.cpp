// SPDX-License-Identifier: Apache-2.0
#include "client/play/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace fieldcast::client::play {
namespace {

/// Nearest rank; `values` must not be empty.
double percentile(const std::vector<double>& sorted, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

std::optional<Percentiles> percentiles(std::vector<double> values) {
    if (values.empty()) {
        return std::nullopt;
    }
    std::sort(values.begin(), values.end());
    return Percentiles{percentile(values, 0.50), percentile(values, 0.95)};
}

template <class Member> std::vector<double> known(const std::vector<ShownFrame>& frames, Member member) {
    std::vector<double> values;
    for (const ShownFrame& frame : frames) {
        if (const std::optional<double> value = frame.*member) {
            values.push_back(*value);
        }
    }
    return values;
}

double percent(const std::vector<ShownFrame>& frames, std::uint64_t ShownFrame::*count) {
    std::uint64_t discarded = 0;
    std::uint64_t pixels = 0;
    for (const ShownFrame& frame : frames) {
        discarded += frame.*count;
        pixels += frame.view_pixels;
    }
    return pixels == 0 ? 0.0 : 100.0 * static_cast<double>(discarded) / static_cast<double>(pixels);
}

double mean_bytes(const std::vector<ShownFrame>& frames) {
    double bytes = 0.0;
    for (const ShownFrame& frame : frames) {
        bytes += static_cast<double>(frame.payload_bytes);
    }
    return frames.empty() ? 0.0 : bytes / static_cast<double>(frames.size());
}

double rate(const std::vector<ShownFrame>& frames) {
    if (frames.size() < 2) {
        return 0.0;
    }
    const double seconds = static_cast<double>(frames.back().shown_ns - frames.front().shown_ns) * 1e-9;
    return seconds > 0.0 ? static_cast<double>(frames.size() - 1) / seconds : 0.0;
}

template <class... Values> std::string line(const char* format, Values... values) {
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

std::string latency_line(const char* name, const std::optional<Percentiles>& value) {
    return value ? line("%-20s %.1f ms p50, %.1f ms p95\n", name, value->p50, value->p95)
                 : line("%-20s unknown\n", name);
}

nlohmann::json to_json(const std::optional<Percentiles>& value) {
    return value ? nlohmann::json{{"p50", value->p50}, {"p95", value->p95}} : nlohmann::json();
}

} // namespace

void add_discards(const Views& views, ShownFrame& frame) {
    for (const View& view : views.views) {
        frame.view_pixels += std::uint64_t{view.image.width_px} * view.image.height_px;
        frame.out_of_frustum += view.discards.out_of_frustum;
        frame.id += view.discards.id;
        frame.plane += view.discards.plane;
        frame.normal += view.discards.normal;
    }
}

Summary summarise(const std::vector<ShownFrame>& frames, const StreamCounts& counts) {
    Summary summary;
    summary.shown = frames.size();
    summary.counts = counts;
    summary.frames_per_second = rate(frames);
    summary.bytes_per_frame = mean_bytes(frames);
    summary.send_to_decoded_ms = percentiles(known(frames, &ShownFrame::send_to_decoded_ms));
    summary.pose_to_decoded_ms = percentiles(known(frames, &ShownFrame::pose_to_decoded_ms));
    summary.pose_to_shown_ms = percentiles(known(frames, &ShownFrame::pose_to_shown_ms));
    const std::vector<double> motion_ms = known(frames, &ShownFrame::motion_to_photon_ms);
    summary.poses_shown = motion_ms.size();
    summary.motion_to_photon_ms = percentiles(motion_ms);
    summary.decode_ms = percentiles(known(frames, &ShownFrame::decode_ms)).value_or(Percentiles{});
    summary.render_ms = percentiles(known(frames, &ShownFrame::render_ms)).value_or(Percentiles{});
    summary.out_of_frustum_percent = percent(frames, &ShownFrame::out_of_frustum);
    summary.id_percent = percent(frames, &ShownFrame::id);
    summary.plane_percent = percent(frames, &ShownFrame::plane);
    summary.normal_percent = percent(frames, &ShownFrame::normal);
    summary.discarded_percent =
        summary.out_of_frustum_percent + summary.id_percent + summary.plane_percent + summary.normal_percent;
    for (const ShownFrame& frame : frames) {
        summary.frame_ids.push_back(frame.frame_id);
    }
    return summary;
}

std::string to_table(const Summary& s) {
    const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::string table = line("%-20s %s, %s views of %s\n", "mode", s.mode.c_str(), s.grid.c_str(), s.view_size.c_str());
    table += line("%-20s %llu shown, %.2f per second\n", "frames", number(s.shown), s.frames_per_second);
    table += line("%-20s %.0f (%.2f MB)\n", "bytes per frame", s.bytes_per_frame, s.bytes_per_frame * 1e-6);
    table += latency_line("latency, sent", s.send_to_decoded_ms);
    table += latency_line("latency, pose", s.pose_to_decoded_ms);
    table += latency_line("pose to shown", s.pose_to_shown_ms);
    if (s.motion_to_photon_ms) {
        table += latency_line("motion to photon", s.motion_to_photon_ms);
        table += line("%-20s %llu of ours\n", "poses shown", number(s.poses_shown));
    }
    table += latency_line("decoding", s.decode_ms);
    table += latency_line("making views", s.render_ms);
    table += line("%-20s %.2f %% (out of frustum %.2f, id %.2f, plane %.2f, normal %.2f)\n", "discards",
                  s.discarded_percent, s.out_of_frustum_percent, s.id_percent, s.plane_percent, s.normal_percent);
    table += line("%-20s %llu superseded, %llu aborted, %llu failed\n", "not shown", number(s.counts.superseded),
                  number(s.counts.aborted), number(s.counts.failed));
    table += line("%-20s %u\n", "sessions", s.counts.sessions);
    for (const EpochSummary& epoch : s.epochs) {
        if (s.epochs.size() > 1) {
            table += line("%-20s %s, %s views of %s: %llu shown, %.0f bytes per frame%s%s\n",
                          ("epoch " + std::to_string(epoch.epoch)).c_str(), epoch.mode.c_str(), epoch.grid.c_str(),
                          epoch.view_size.c_str(), number(epoch.shown), epoch.bytes_per_frame,
                          epoch.reason.empty() ? "" : "; ", epoch.reason.c_str());
        }
    }
    return table;
}

std::string to_json(const Summary& s) {
    nlohmann::ordered_json json;
    json["mode"] = s.mode;
    json["grid"] = s.grid;
    json["view_size"] = s.view_size;
    json["shown"] = s.shown;
    json["frames_per_second"] = s.frames_per_second;
    json["bytes_per_frame"] = s.bytes_per_frame;
    json["send_to_decoded_ms"] = to_json(s.send_to_decoded_ms);
    json["pose_to_decoded_ms"] = to_json(s.pose_to_decoded_ms);
    json["pose_to_shown_ms"] = to_json(s.pose_to_shown_ms);
    json["motion_to_photon_ms"] = to_json(s.motion_to_photon_ms);
    json["poses_shown"] = s.poses_shown;
    json["decode_ms"] = to_json(std::optional(s.decode_ms));
    json["render_ms"] = to_json(std::optional(s.render_ms));
    json["discarded_percent"] = s.discarded_percent;
    json["out_of_frustum_percent"] = s.out_of_frustum_percent;
    json["id_percent"] = s.id_percent;
    json["plane_percent"] = s.plane_percent;
    json["normal_percent"] = s.normal_percent;
    json["superseded"] = s.counts.superseded;
    json["aborted"] = s.counts.aborted;
    json["failed"] = s.counts.failed;
    json["sessions"] = s.counts.sessions;
    json["changes"] = s.counts.changes;
    json["adaptations"] = s.counts.adaptations;
    json["epochs"] = nlohmann::json::array();
    for (const EpochSummary& epoch : s.epochs) {
        json["epochs"].push_back({{"session", epoch.session},
                                  {"epoch", epoch.epoch},
                                  {"mode", epoch.mode},
                                  {"grid", epoch.grid},
                                  {"view_size", epoch.view_size},
                                  {"shown", epoch.shown},
                                  {"first_frame", epoch.first_frame},
                                  {"last_frame", epoch.last_frame},
                                  {"bytes_per_frame", epoch.bytes_per_frame},
                                  {"reason", epoch.reason}});
    }
    json["frame_ids"] = s.frame_ids;
    return json.dump(2) + "\n";
}

} // namespace fieldcast::client::play
