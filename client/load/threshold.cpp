// SPDX-License-Identifier: Apache-2.0
#include "client/load/threshold.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fieldcast::client::load {
namespace {

constexpr std::array<std::pair<std::string_view, double>, 6> kShares{
    {{"p50", 0.5}, {"p90", 0.9}, {"p95", 0.95}, {"p99", 0.99}, {"p999", 0.999}, {"max", 1.0}}};

constexpr std::array<std::pair<std::string_view, Quantity>, 7> kQuantities{{
    {"least_fps", Quantity::kLeastFps},
    {"least_fairness", Quantity::kLeastFairness},
    {"most_failed", Quantity::kMostFailed},
    {"most_aborted", Quantity::kMostAborted},
    {"most_refused", Quantity::kMostRefused},
    {"most_lost", Quantity::kMostLost},
    {"most_without_frames", Quantity::kMostWithout},
}};

/// Splits "first_frame_p99_ms" into first_frame and p99.
std::optional<LatencyLimit> latency_of(std::string_view name) {
    constexpr std::string_view kUnit = "_ms";
    if (!name.ends_with(kUnit)) {
        return std::nullopt;
    }
    name.remove_suffix(kUnit.size());
    const std::size_t cut = name.rfind('_');
    if (cut == std::string_view::npos) {
        return std::nullopt;
    }
    const std::optional<Stage> stage = stage_of(name.substr(0, cut));
    const auto* const share = std::ranges::find(kShares, name.substr(cut + 1), &decltype(kShares)::value_type::first);
    if (!stage || share == kShares.end()) {
        return std::nullopt;
    }
    return LatencyLimit{*stage, share->second};
}

} // namespace

std::optional<Threshold> threshold_of(const std::string& name, double limit) {
    if (const auto latency = latency_of(name)) {
        return Threshold{name, *latency, limit};
    }
    for (const auto& [known, quantity] : kQuantities) {
        if (known == name) {
            return Threshold{name, quantity, limit};
        }
    }
    return std::nullopt;
}

std::string threshold_names() {
    std::string text = "STAGE_pNN_ms with STAGE one of ";
    for (const StageText& stage : kStages) {
        text += std::string(stage.name) + " ";
    }
    text += "and pNN one of ";
    for (const auto& [name, share] : kShares) {
        text += std::string(name) + " ";
    }
    text += "(as in due_p99_ms); ";
    for (const auto& [name, quantity] : kQuantities) {
        text += std::string(name) + (quantity == kQuantities.back().second ? "" : ", ");
    }
    return text;
}

} // namespace fieldcast::client::load
