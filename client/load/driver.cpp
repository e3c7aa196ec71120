// SPDX-License-Identifier: Apache-2.0
#include "client/load/driver.h"

#include "core/base/log.h"

namespace fieldcast::client::load {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLookAtStop{200};

} // namespace

Driver::Driver(const Scenario& scenario, const Window& window, std::vector<Start> starts)
    : tallies_(scenario.groups.size()), starts_(std::move(starts)), alarm_of_(starts_.size(), TimePoint::max()) {
    mail_.lock()->is_in.assign(starts_.size(), false);
    add_clients(scenario, window);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

Driver::~Driver() {
    thread_.request_stop();
    if (thread_.joinable()) {
        thread_.join();
    }
}

void Driver::add_clients(const Scenario& scenario, const Window& window) {
    for (std::size_t i = 0; i < starts_.size(); ++i) {
        const Start& start = starts_[i];
        LoadClient::Surroundings surroundings{.scenario = &scenario,
                                              .group = &scenario.groups[start.group],
                                              .window = window,
                                              .pool = &pool_,
                                              .tally = &tallies_[start.group],
                                              .on_change = [this, i] { note(i); }};
        clients_.push_back(std::make_unique<LoadClient>(std::move(surroundings), start.seed, start.at));
        alarms_.emplace(start.at, i);
        alarm_of_[i] = start.at;
    }
}

void Driver::note(std::size_t client) {
    auto mail = mail_.lock();
    if (!mail->is_in[client]) {
        mail->is_in[client] = true;
        mail->changed.push_back(client);
        changed_.notify_one();
    }
}

void Driver::begin_to_finish() {
    mail_.lock()->is_finishing = true;
    changed_.notify_one();
}

std::optional<std::string> Driver::finish() {
    begin_to_finish();
    if (thread_.joinable()) {
        thread_.join();
    }
    return mail_.lock()->failure;
}

std::vector<ClientShare> Driver::shares_of(std::size_t group) const {
    std::vector<ClientShare> shares;
    for (std::size_t i = 0; i < clients_.size(); ++i) {
        if (starts_[i].group == group) {
            shares.push_back(clients_[i]->share());
        }
    }
    return shares;
}

void Driver::run(const std::stop_token& stop) {
    try {
        drive(stop);
    } catch (const std::exception& error) {
        log::error("driver failed", {{"reason", error.what()}});
        mail_.lock()->failure = error.what();
    }
}

void Driver::drive(const std::stop_token& stop) {
    bool has_left = false;
    while (!stop.stop_requested()) {
        const auto [clients, is_finishing] = wait_for_work(stop, has_left);
        for (const std::size_t client : clients) {
            run_client(client);
        }
        while (!alarms_.empty() && alarms_.begin()->first <= Clock::now()) {
            run_client(alarms_.begin()->second);
        }
        if (is_finishing && !has_left) {
            leave_all();
            has_left = true;
        }
        if (has_left && alarms_.empty()) {
            return;
        }
    }
}

Driver::Work Driver::wait_for_work(const std::stop_token& stop, bool has_left) {
    const TimePoint alarm = alarms_.empty() ? TimePoint::max() : alarms_.begin()->first;
    auto mail = mail_.lock();
    mail.wait_until(changed_, std::min(alarm, Clock::now() + kLookAtStop),
                    [&](const Mail& m) {
                        return !m.changed.empty() || (m.is_finishing && !has_left) || stop.stop_requested();
                    });
    for (const std::size_t client : mail->changed) {
        mail->is_in[client] = false;
    }
    return {std::exchange(mail->changed, {}), mail->is_finishing};
}

/// Runs a client and replaces its alarm; a client that has left has none.
void Driver::run_client(std::size_t client) {
    LoadClient& each = *clients_[client];
    const TimePoint next = each.is_gone() ? TimePoint::max() : each.run();
    alarms_.erase({alarm_of_[client], client});
    alarm_of_[client] = next;
    if (!each.is_gone()) {
        alarms_.emplace(next, client);
    }
}

void Driver::leave_all() {
    for (std::size_t i = 0; i < clients_.size(); ++i) {
        clients_[i]->leave_for_good();
        run_client(i);
    }
}

} // namespace fieldcast::client::load
