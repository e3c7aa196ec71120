// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/load_client.h"

#include <condition_variable>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace fieldcast::client::load {

/// A thread that runs many clients: it sleeps until a message arrives for one of them or one has something to do.
class Driver {
public:
    /// A client to create: group, seed, start.
    struct Start {
        std::size_t group = 0; ///< index in the scenario
        std::uint32_t seed = 0;
        LoadClient::TimePoint at;
    };

    Driver(const Scenario& scenario, const Window& window, std::vector<Start> starts);
    ~Driver();
    Driver(const Driver&) = delete;
    Driver& operator=(const Driver&) = delete;

    /// Counts of all clients of a group so far.
    Tally tally_of(std::size_t group) { return *tallies_[group].lock(); }

    /// Makes all clients leave. Returns at once.
    void begin_to_finish();

    /// Waits until all clients have left, a few seconds at most. Returns why the thread failed, if it did.
    std::optional<std::string> finish();

    /// Call it after `finish`.
    std::vector<ClientShare> shares_of(std::size_t group) const;

private:
    using TimePoint = LoadClient::TimePoint;
    struct Mail {
        std::deque<std::size_t> changed; ///< indices of clients, each once
        std::vector<bool> is_in;
        bool is_finishing = false;
        std::optional<std::string> failure;
    };

    struct Work {
        std::deque<std::size_t> clients;
        bool is_finishing = false;
    };

    void add_clients(const Scenario& scenario, const Window& window);
    void note(std::size_t client); ///< from any thread: there is a message for it
    void run(const std::stop_token& stop);
    void drive(const std::stop_token& stop);
    Work wait_for_work(const std::stop_token& stop, bool has_left);
    void run_client(std::size_t client);
    void leave_all();

    WorkerPool pool_{1};
    std::vector<Guarded<Tally>> tallies_; ///< by group
    std::condition_variable changed_;
    Guarded<Mail> mail_;
    std::vector<Start> starts_;
    std::vector<std::unique_ptr<LoadClient>> clients_;
    std::set<std::pair<TimePoint, std::size_t>> alarms_; ///< latest moment to run a client, and its index
    std::vector<TimePoint> alarm_of_;                    ///< by client; max: none
    std::jthread thread_;
};

} // namespace fieldcast::client::load
