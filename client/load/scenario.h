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

/// Clients with the same settings; fairness and percentiles are per group.
struct Group {
    std::string name;
    std::uint32_t count = 1;
    net::Request request{};
    wire::Decoding decoding = wire::Decoding::kChecksum;
    double due_fps = 0.0;              ///< due moments per second; 0: the frame rate that the server announces
    double max_bytes_per_second = 0.0; ///< slow reader; 0: no limit
    Seconds think{0};                  ///< time without reading after each frame
    Seconds stay{0};                   ///< churn: mean time until it leaves (0.5 to 1.5 times that); 0: it stays
    Seconds away{1};                   ///< churn: mean time until it returns
    bool leaves_abruptly = false;      ///< churn: closes the connection without half-closing the stream
    std::vector<Threshold> thresholds{};
};

/// All settings of a run. Validated once, then never changed.
struct Scenario {
    std::string name = "load";
    std::string address = "127.0.0.1:50151"; ///< "host:port"
    net::Access access{};
    Seconds ramp{0};      ///< clients start evenly spread over it; counting begins at its end
    Seconds duration{30}; ///< after the ramp; 0: until interrupted
    std::uint32_t seed = 1;
    std::uint32_t threads = 0; ///< decoder threads; 0: one per hardware thread
    std::string metrics_url{}; ///< http://127.0.0.1:PORT/metrics; empty: none
    std::vector<Group> groups{};
    std::vector<Threshold> thresholds{}; ///< for every group
};

std::uint32_t client_count(const Scenario& scenario);

/// "full", "checksum", "headers".
std::string_view name_of(wire::Decoding decoding);

/// Sets one field of a scenario or a group by its name in scenario files. Returns the problem; empty: none.
/// `set_in_group("grid", {"3x3"}, group)`.
std::string set_in_group(const std::string& key, const std::string& value, Group& group);
std::string set_in_scenario(const std::string& key, const std::string& value, Scenario& scenario);
std::string set_in_target(const std::string& key, const std::string& value, Scenario& scenario);
std::string add_threshold(const std::string& key, const std::string& value, std::vector<Threshold>& thresholds);

/// Problems of the scenario as a whole; empty: none.
std::vector<std::string> problems_of(const Scenario& scenario);

/// Reads a scenario file. Throws UserError with all problems, one per line, each with file, line and key.
Scenario read_scenario(const std::filesystem::path& file);

inline constexpr std::uint32_t kMaxClients = 20'000;

} // namespace fieldcast::client::load
