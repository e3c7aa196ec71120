// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/threshold.h"
#include "client/net/access.h"
#include "client/net/configure.h"
#include "core/wire/frame_assembler.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace fieldcast::client::load {

using Seconds = std::chrono::duration<double>;

/// Clients that behave alike: a class, for fairness and percentiles.
struct Group {
    std::string name;
    std::uint32_t count = 1;
    net::Request request{};
    wire::Decoding decoding = wire::Decoding::kChecksum;
    double due_fps = 0.0;              ///< of the schedule; 0: what the server means to send
    double max_bytes_per_second = 0.0; ///< slow reader; 0: reads as fast as it can
    Seconds think{0};                  ///< reads nothing for so long after each frame
    Seconds stay{0};                   ///< churn: leaves after about so long (half to one and a half); 0: stays
    Seconds away{1};                   ///< churn: comes back after about so long
    bool leaves_abruptly = false;      ///< churn: cuts the connection instead of half-closing
    std::vector<Threshold> thresholds{};
};

/// What a run does. Validated once, then never changed.
struct Scenario {
    std::string name = "load";
    std::string address = "127.0.0.1:50151"; ///< "host:port"
    net::Access access{};
    Seconds ramp{0};      ///< clients start evenly spread over it; nothing is counted before it has ended
    Seconds duration{30}; ///< after the ramp; 0: until interrupted
    std::uint32_t seed = 1;
    std::uint32_t threads = 0; ///< that decode; 0: one per hardware thread
    std::string metrics_url{}; ///< http://127.0.0.1:PORT/metrics; empty: none
    std::vector<Group> groups{};
    std::vector<Threshold> thresholds{}; ///< of every group
};

std::uint32_t client_count(const Scenario& scenario);

/// "full", "checksum", "headers".
std::string_view name_of(wire::Decoding decoding);

/// One more setting of a scenario or a group, by its name in scenario files. Returns the problem; empty: none.
/// `set_in_group("grid", {"3x3"}, group)`.
std::string set_in_group(const std::string& key, const std::string& value, Group& group);
std::string set_in_scenario(const std::string& key, const std::string& value, Scenario& scenario);
std::string set_in_target(const std::string& key, const std::string& value, Scenario& scenario);
std::string add_threshold(const std::string& key, const std::string& value, std::vector<Threshold>& thresholds);

/// What is wrong with it as a whole; empty: nothing.
std::vector<std::string> problems_of(const Scenario& scenario);

/// Reads a scenario file. Throws UserError with all problems, one per line, each with file, line and key.
Scenario read_scenario(const std::filesystem::path& file);

inline constexpr std::uint32_t kMaxClients = 20'000;

} // namespace fieldcast::client::load
