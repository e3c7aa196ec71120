// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/stage.h"

#include <optional>
#include <string>
#include <variant>

namespace fieldcast::client::load {

/// Quantities other than latencies that a threshold can limit.
enum class Quantity : std::uint8_t {
    kLeastFps,       ///< frames per second of the slowest client, at least
    kLeastFairness,  ///< Jain's index of the clients' frame rates, at least
    kMostFailed,     ///< frames that were damaged or not as configured, at most
    kMostAborted,    ///< frames that the server aborted, at most
    kMostRefused,    ///< refusals by the server, at most
    kMostLost,       ///< streams that broke, at most
    kMostWithout,    ///< clients without any frame, at most
};

/// A latency that `share` of all values must not exceed.
struct LatencyLimit {
    Stage stage = Stage::kDue;
    double share = 0.99; ///< 1: the largest value
};

/// A condition for every group; the run misses it if one group does not meet it.
struct Threshold {
    std::string name; ///< "due_p99_ms", "least_fps"
    std::variant<LatencyLimit, Quantity> of;
    double limit = 0.0; ///< in milliseconds for latencies, else in the unit of the quantity
};

/// A threshold by its name: STAGE_p50_ms, _p90, _p95, _p99, _p999, _max, or a quantity. Nothing if the name is unknown.
std::optional<Threshold> threshold_of(const std::string& name, double limit);

/// All names as text for messages and help.
std::string threshold_names();

} // namespace fieldcast::client::load
