// SPDX-License-Identifier: Apache-2.0
#include "client/load/load_result.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace fieldcast::client::load {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const LatencyHistogram& latencies) {
    const auto at = [&](double share) { return static_cast<double>(latencies.percentile_us(share)) * 1e-3; };
    return {{"count", latencies.count()}, {"mean_ms", latencies.mean_us() * 1e-3},
            {"p50_ms", at(0.5)},          {"p90_ms", at(0.9)},
            {"p95_ms", at(0.95)},         {"p99_ms", at(0.99)},
            {"p999_ms", at(0.999)},       {"max_ms", at(1.0)}};
}

Json to_json(const Group& group) {
    return {{"name", group.name},
            {"clients", group.count},
            {"mode", word_of(group.request.mode)},
            {"grid", std::to_string(group.request.rows) + "x" + std::to_string(group.request.cols)},
            {"size", std::to_string(group.request.width_px) + "x" + std::to_string(group.request.height_px)},
            {"decoding", name_of(group.decoding)},
            {"due_fps", group.due_fps},
            {"reads_kbit_per_second", group.max_bytes_per_second * 8.0 / 1000.0},
            {"think_s", group.think.count()},
            {"stay_s", group.stay.count()},
            {"away_s", group.away.count()}};
}

Json seconds_of(const Tally& tally) {
    Json seconds = Json::array();
    for (const Second& second : tally.seconds) {
        seconds.push_back({{"frames", second.frames},
                           {"bytes", second.bytes},
                           {"longest_due_ms", static_cast<double>(second.longest_due_us) * 1e-3}});
    }
    return seconds;
}

Json to_json(const GroupResult& result, double seconds) {
    const Tally& tally = result.tally;
    Json json = to_json(result.group);
    json["frames"] = tally.frames;
    json["bytes"] = tally.bytes;
    json["bytes_per_second"] = seconds > 0.0 ? static_cast<double>(tally.bytes) / seconds : 0.0;
    json["mean_fps"] = result.mean_fps();
    json["least_fps"] = result.least_fps();
    json["fairness"] = result.fairness;
    json["clients_without_frames"] = result.without_frames();
    json["client_fps"] = result.client_fps;
    json["not_sent"] = tally.not_sent;
    json["aborted"] = tally.aborted;
    json["failed"] = tally.failed;
    json["refused"] = tally.refused;
    json["lost"] = tally.lost;
    json["sent_away"] = tally.sent_away;
    json["due_moments_cut_off"] = tally.cut_off;
    json["frames_without_pose_time"] = tally.without_pose_time;
    json["reasons"] = tally.reasons;
    for (std::size_t i = 0; i < kStageCount; ++i) {
        json["stages"][std::string(kStages[i].name)] = to_json(tally.stages[i]);
    }
    json["seconds"] = seconds_of(tally);
    return json;
}

Json metrics_of(const LoadResult& result) {
    Json json = Json::object();
    for (const auto& [name, after] : result.metrics_after) {
        const auto before = result.metrics_before.find(name);
        json[name] = {{"before", before == result.metrics_before.end() ? Json() : Json(before->second)},
                      {"after", after}};
    }
    return json;
}

} // namespace

std::string to_json(const LoadResult& result) {
    Json json;
    json["scenario"] = result.scenario.name;
    json["address"] = result.scenario.address;
    json["began_at"] = result.began_at;
    json["ramp_s"] = result.scenario.ramp.count();
    json["seconds"] = result.seconds;
    json["was_interrupted"] = result.was_interrupted;
    json["clients"] = client_count(result.scenario);
    json["cpu_seconds"] = result.cpu_seconds;
    json["cpu_percent_per_client"] = result.cpu_percent_per_client();
    json["holds"] = result.holds();
    json["groups"] = Json::array();
    for (const GroupResult& group : result.groups) {
        json["groups"].push_back(to_json(group, result.seconds));
    }
    json["thresholds"] = Json::array();
    for (const Check& check : result.checks) {
        json["thresholds"].push_back({{"group", check.group},
                                      {"threshold", check.threshold.name},
                                      {"limit", check.threshold.limit},
                                      {"measured", check.measured},
                                      {"holds", check.holds}});
    }
    json["server_metrics"] = metrics_of(result);
    json["server_metrics_problem"] = result.metrics_problem;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; // reasons are text from outside
}

} // namespace fieldcast::client::load
