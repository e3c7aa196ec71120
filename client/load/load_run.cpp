// SPDX-License-Identifier: Apache-2.0
#include "client/load/load_run.h"

#include "client/load/driver.h"
#include "core/base/log.h"

#include <algorithm>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <stdexcept>
#include <sys/resource.h>
#include <thread>

namespace fieldcast::client::load {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

constexpr double kNsPerSecond = 1e9;

/// Raises the limit of file descriptors; a client needs a socket and a few more.
void allow_files(std::uint32_t clients) {
    constexpr rlim_t kPerClient = 4;
    constexpr rlim_t kOthers = 256;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kPerClient * clients + kOthers) {
        return;
    }
    limit.rlim_cur = std::min(limit.rlim_max, kPerClient * clients + kOthers);
    ::setrlimit(RLIMIT_NOFILE, &limit);
    if (limit.rlim_cur < clients + kOthers) {
        log::warn("few file descriptors", {{"limit", limit.rlim_cur}, {"clients", clients}});
    }
}

double cpu_seconds() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string utc_now() {
    const std::time_t now = std::time(nullptr);
    std::tm broken{};
    ::gmtime_r(&now, &broken);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &broken);
    return text.data();
}

std::int64_t to_ns(Seconds seconds) {
    return static_cast<std::int64_t>(seconds.count() * kNsPerSecond);
}

/// Interleaves the starts of all groups, so that their shares of the started clients are constant during the ramp.
std::vector<Driver::Start> starts_of(const Scenario& scenario, Clock::time_point begin) {
    struct Place {
        double share;
        std::size_t group;
    };
    std::vector<Place> places;
    for (std::size_t group = 0; group < scenario.groups.size(); ++group) {
        const std::uint32_t count = scenario.groups[group].count;
        for (std::uint32_t i = 0; i < count; ++i) {
            places.push_back({(i + 0.5) / count, group});
        }
    }
    std::ranges::stable_sort(places, {}, &Place::share);
    std::vector<Driver::Start> starts;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto after = scenario.ramp * (static_cast<double>(i) / static_cast<double>(places.size()));
        starts.push_back({places[i].group, scenario.seed + static_cast<std::uint32_t>(i),
                          begin + std::chrono::duration_cast<Clock::duration>(after)});
    }
    return starts;
}

/// A running scenario.
class Run {
public:
    Run(const Scenario& scenario, const std::function<void(const LoadProgress&)>& on_progress, std::stop_token stop)
        : scenario_(scenario), on_progress_(on_progress), stop_(std::move(stop)), begin_ns_(net::steady_now_ns()) {
        window_.begin_ns = begin_ns_ + to_ns(scenario.ramp);
        window_.end_ns = scenario.duration > 0s ? window_.begin_ns + to_ns(scenario.duration) : INT64_MAX;
        if (!scenario.metrics_url.empty()) {
            metrics_url_ = *parse_metrics_url(scenario.metrics_url);
        }
        start_drivers();
    }

    LoadResult result() {
        LoadResult result;
        result.scenario = scenario_;
        result.began_at = utc_now();
        wait_until(window_.begin_ns, true);
        result.metrics_before = metrics(result);
        const double cpu_before = cpu_seconds();
        wait_until(window_.end_ns, false);
        result.was_interrupted = stop_.stop_requested();
        window_.end_ns = std::min(window_.end_ns, net::steady_now_ns());
        result.seconds = std::max(0.0, static_cast<double>(window_.end_ns - window_.begin_ns) / kNsPerSecond);
        result.cpu_seconds = cpu_seconds() - cpu_before;
        result.metrics_after = metrics(result);
        finish_drivers();
        for (std::size_t group = 0; group < scenario_.groups.size(); ++group) {
            result.groups.push_back(group_result(group));
        }
        result.checks = checks_of(scenario_, result.groups);
        return result;
    }

private:
    void start_drivers() {
        const std::vector<Driver::Start> starts =
            starts_of(scenario_, Clock::time_point(std::chrono::nanoseconds(begin_ns_)));
        const std::size_t wanted =
            scenario_.threads != 0 ? scenario_.threads : std::max(1U, std::thread::hardware_concurrency());
        const std::size_t count = std::min(wanted, starts.size());
        for (std::size_t i = 0; i < count; ++i) {
            std::vector<Driver::Start> own;
            for (std::size_t k = i; k < starts.size(); k += count) {
                own.push_back(starts[k]);
            }
            drivers_.push_back(std::make_unique<Driver>(scenario_, window_, std::move(own)));
        }
    }

    void finish_drivers() {
        for (const auto& driver : drivers_) {
            driver->begin_to_finish();
        }
        for (const auto& driver : drivers_) {
            if (const auto failure = driver->finish()) {
                throw std::runtime_error(*failure);
            }
        }
    }

    Tally tally_of(std::size_t group) {
        Tally tally;
        for (const auto& driver : drivers_) {
            tally.add(driver->tally_of(group));
        }
        return tally;
    }

    GroupResult group_result(std::size_t group) {
        GroupResult result{.group = scenario_.groups[group], .tally = tally_of(group), .client_fps = {}};
        for (const auto& driver : drivers_) {
            for (const ClientShare& share : driver->shares_of(group)) {
                result.client_fps.push_back(share.fps());
            }
        }
        result.fairness = jain_index(result.client_fps);
        return result;
    }

    Metrics metrics(LoadResult& result) {
        if (!metrics_url_) {
            return {};
        }
        auto fetched = fetch_metrics(*metrics_url_, 2s);
        if (!fetched) {
            result.metrics_problem = fetched.error();
            return {};
        }
        return std::move(*fetched);
    }

    /// Waits until that moment or a stop request and reports progress once a second.
    void wait_until(std::int64_t end_ns, bool is_ramp) {
        std::mutex mutex;
        std::condition_variable_any never;
        std::unique_lock lock(mutex);
        while (!stop_.stop_requested() && net::steady_now_ns() < end_ns) {
            const std::int64_t left_ns = end_ns - net::steady_now_ns();
            never.wait_for(lock, stop_, std::min(std::chrono::nanoseconds(left_ns), std::chrono::nanoseconds(1s)),
                           [] { return false; });
            tell(is_ramp);
        }
    }

    void tell(bool is_ramp) {
        const std::int64_t now_ns = net::steady_now_ns();
        const double since_before = static_cast<double>(now_ns - told_ns_) / kNsPerSecond;
        told_ns_ = now_ns;
        LoadProgress progress;
        progress.is_ramp = is_ramp;
        progress.seconds = static_cast<double>(now_ns - (is_ramp ? begin_ns_ : window_.begin_ns)) / kNsPerSecond;
        progress.of_seconds = is_ramp ? scenario_.ramp.count() : scenario_.duration.count();
        for (std::size_t group = 0; group < scenario_.groups.size(); ++group) {
            progress.groups.push_back(group_line(group, since_before));
        }
        on_progress_(progress);
    }

    LoadProgress::GroupLine group_line(std::size_t group, double since_before) {
        const Tally tally = tally_of(group);
        Told& told = told_[group];
        LoadProgress::GroupLine line{.name = scenario_.groups[group].name,
                                     .clients = scenario_.groups[group].count,
                                     .connected = tally.connected,
                                     .frames = tally.frames,
                                     .failed = tally.failed + tally.aborted,
                                     .lost = tally.lost + tally.refused};
        line.fps = static_cast<double>(tally.frames - told.frames) / since_before;
        line.megabytes_per_second = static_cast<double>(tally.bytes - told.bytes) * 1e-6 / since_before;
        line.due_p50_ms = static_cast<double>(tally.of(Stage::kDue).percentile_us(0.5)) * 1e-3;
        line.due_p99_ms = static_cast<double>(tally.of(Stage::kDue).percentile_us(0.99)) * 1e-3;
        told = {tally.frames, tally.bytes};
        return line;
    }

    struct Told {
        std::uint64_t frames = 0;
        std::uint64_t bytes = 0;
    };

    const Scenario& scenario_;
    const std::function<void(const LoadProgress&)>& on_progress_;
    std::stop_token stop_;
    std::int64_t begin_ns_;
    Window window_;
    std::optional<MetricsUrl> metrics_url_;
    std::int64_t told_ns_ = begin_ns_;
    std::vector<Told> told_ = std::vector<Told>(scenario_.groups.size());
    std::vector<std::unique_ptr<Driver>> drivers_;
};

} // namespace

LoadResult run_load(const Scenario& scenario, const std::function<void(const LoadProgress&)>& on_progress,
                    const std::stop_token& stop) {
    allow_files(client_count(scenario));
    const net::Connection tried(scenario.address, scenario.access); // throws once if the access is not usable
    return Run(scenario, on_progress, stop).result();
}

} // namespace fieldcast::client::load
