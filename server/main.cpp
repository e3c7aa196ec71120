// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/printable.h"
#include "core/base/stop_signals.h"
#include "server/channel/channel_list.h"
#include "server/channel/offline_recording.h"
#include "server/listener/descriptor.h"
#include "server/metrics/process_metrics.h"
#include "server/ops/flags.h"
#include "server/ops/port_file.h"
#include "server/service/grpc_server.h"
#include "server/service/health_probe.h"
#include "server/session/frame_timings.h"
#include "server/web/endpoint.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <future>
#include <iostream>
#include <thread>

namespace {

using namespace fieldcast;
using Clock = std::chrono::steady_clock;

constexpr int kOk = 0;
constexpr int kMachineFailed = 1;
constexpr int kUserError = 2;
constexpr int kDeaf = 3; // a supervisor starts it again
constexpr int kInterrupted = 130;

constexpr std::chrono::milliseconds kPollInterval{100};
constexpr std::chrono::milliseconds kStartPollInterval{20}; // also what a start takes longer than it needs
constexpr std::chrono::seconds kDrainLimit{8}; // the spread of GoingAway, its deadline, and some room

constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8"; // of metrics::Page

/// What the process says about itself, whatever it serves.
void collect_process(metrics::Page& page) {
    page.add_gauge({"fieldcast_build_info", "1; the version stands in the label."}, {{"version", FIELDCAST_VERSION}},
                   1.0);
    metrics::add_process_metrics(page);
}

/// What the address of the metrics answers.
std::vector<web::Route> metrics_routes(metrics::Registry& registry) {
    const auto page = [&registry](const web::Request&) {
        return web::Answer{.content_type = kMetricsType, .body = registry.page().text()};
    };
    const auto index = [](const web::Request&) {
        return web::Answer{.body = "The metrics of this server are at /metrics.\n"};
    };
    return {{.path = "/metrics", .role = access::Role::kAdmin, .get = page},
            {.path = "/", .role = access::Role::kAdmin, .get = index}};
}

/// /metrics, if it was asked for, and its port file.
class MetricsServer {
public:
    MetricsServer(const ops::Config& config, const access::Gate& gate, metrics::Registry& registry)
        : collector_(registry.on_collect(collect_process)) {
        if (!config.metrics_listen) {
            return;
        }
        const web::Listening listening{
            .address = *config.metrics_listen, .flag = "--metrics-listen", .security = config.security};
        endpoint_.emplace(listening, gate, metrics_routes(registry));
        log::info("metrics", {{"listen", to_text({.host = config.metrics_listen->host, .port = endpoint_->port()})}});
        if (config.metrics_port_file) {
            port_file_.emplace(*config.metrics_port_file, endpoint_->port());
        }
    }

private:
    metrics::Collector collector_;
    std::optional<web::Endpoint> endpoint_;
    std::optional<ops::PortFile> port_file_;
};

/// Every frame of every channel, for clients or not, goes to the files that were asked for.
void record_frames(const std::vector<std::shared_ptr<feed::Feed>>& feeds, timing::Recorder& recorder) {
    for (const auto& feed : feeds) {
        feed->observe([&recorder, name = feed->info().name](const feed::FramePtr& frame) {
            recorder.add(session::made_frame(name, *frame));
        });
    }
}

/// Why the server ends: what clients are told, and the exit code.
struct Ending {
    const char* reason;
    int exit_code;
};

/// Until a signal, until a channel fails, or until nobody new gets in.
Ending serve(const StopSignals& signals, const std::vector<std::shared_ptr<feed::Feed>>& feeds,
             const service::GrpcServer& server) {
    const auto has_failed = [](const std::shared_ptr<feed::Feed>& feed) { return feed->has_failed(); };
    while (!signals.wait(kPollInterval)) {
        if (std::ranges::any_of(feeds, has_failed)) {
            return {.reason = "a channel failed", .exit_code = kMachineFailed};
        }
        if (server.is_deaf()) {
            return {.reason = "the port does not answer", .exit_code = kDeaf};
        }
    }
    return {.reason = "the server is shutting down", .exit_code = kOk};
}

/// Until every client has gone, a second signal, or the limit.
void drain(const StopSignals& signals, service::GrpcServer& server, const std::string& reason) {
    server.begin_drain(reason);
    const auto deadline = Clock::now() + kDrainLimit;
    while (Clock::now() < deadline && !server.wait_until_drained(Clock::now() + kPollInterval)) {
        if (signals.wait(std::chrono::milliseconds(0))) {
            log::warn("stopping at once", {{"sessions", server.session_count()}});
            return;
        }
    }
    log::info("drained", {{"sessions", server.session_count()}});
}

/// Everything between the configuration and clients, in the order in which it starts.
class Service {
public:
    /// Ready to serve when constructed. `config` must outlive it.
    explicit Service(const ops::Config& config)
        : recorder_(config.timing_files.any() ? std::make_unique<timing::Recorder>(config.timing_files) : nullptr),
          channels_(config, *registry_),
          server_(config.listen, observed_feeds(), config.limits, config.security,
                  {.registry = registry_, .recorder = recorder_.get()}),
          metrics_server_(config, server_.gate(), *registry_) {}

    const std::vector<std::shared_ptr<feed::Feed>>& feeds() const { return channels_.feeds(); }
    service::GrpcServer& server() { return server_; }

private:
    const std::vector<std::shared_ptr<feed::Feed>>& observed_feeds() {
        if (recorder_ != nullptr) {
            record_frames(channels_.feeds(), *recorder_);
        }
        return channels_.feeds();
    }

    const std::shared_ptr<metrics::Registry> registry_ = std::make_shared<metrics::Registry>();
    const std::unique_ptr<timing::Recorder> recorder_; ///< before the channels: outlives all that tell it something
    const channel::ChannelList channels_;
    service::GrpcServer server_;
    const MetricsServer metrics_server_;
};

/// Starts in a thread of its own, while this one waits for signals: the first one ends the process, whatever the start
/// is at (reading a scene, compiling kernels, a frame on the device). Nobody is served yet, so nothing is cut off.
std::unique_ptr<Service> start_unless_stopped(const ops::Config& config, const StopSignals& signals) {
    std::packaged_task<std::unique_ptr<Service>()> start([&config] { return std::make_unique<Service>(config); });
    auto started = start.get_future();
    const std::jthread thread(std::move(start));
    while (started.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        if (signals.wait(kStartPollInterval)) {
            log::info("stopped while starting", {});
            std::_Exit(kOk); // no destructors: the other thread is at work
        }
    }
    return started.get();
}

int run(const ops::Config& config, const StopSignals& signals) {
    log::set_format(config.log_format);
    log::set_level(config.log_level);
    listener::raise_descriptor_limit();
    const auto service = start_unless_stopped(config, signals);
    service::GrpcServer& server = service->server();
    std::optional<ops::PortFile> port_file;
    if (config.port_file) {
        port_file.emplace(*config.port_file, server.port());
    }
    log::info("SERVING", {{"listen", to_text({.host = config.listen.host, .port = server.port()})},
                          {"tls", config.security.certificates.has_value()},
                          {"tokens", config.security.tokens.has_value()},
                          {"channels", service->feeds().size()}});
    const Ending ending = serve(signals, service->feeds(), server);
    drain(signals, server, ending.reason);
    return ending.exit_code;
}

int probe(const service::HealthQuestion& question) {
    const auto problem = service::health_problem(question);
    std::cout << problem.value_or("SERVING") << '\n';
    return problem ? kMachineFailed : kOk;
}

/// Files instead of a service; several channels get a folder each.
int render(const ops::Config& config, const ops::OfflineJob& job, const StopSignals& signals) {
    log::set_format(config.log_format);
    log::set_level(config.log_level);
    const gpu::Device device({.name_contains = config.device, .validation = config.has_validation});
    log::info("device", {{"name", device.info().name}, {"driver", device.info().driver}});
    for (const ops::ChannelChoice& choice : config.channels) {
        ops::OfflineJob own = job;
        if (config.channels.size() > 1) {
            own.out /= choice.name;
        }
        const auto progress = [&](const std::string& done) {
            std::cerr << '\r' << choice.name << ": " << done << "   " << std::flush;
            return signals.wait(std::chrono::milliseconds(0));
        };
        const bool is_done = channel::render_offline(device, config, choice, own, progress);
        std::cerr << '\n';
        if (!is_done) {
            std::cerr << "interrupted: files that were written are complete\n";
            return kInterrupted;
        }
        std::cout << own.out.string() << '\n';
    }
    return kOk;
}

/// A recording instead of a service.
int record(const ops::Config& config, const ops::RecordJob& job, const StopSignals& signals) {
    log::set_format(config.log_format);
    log::set_level(config.log_level);
    const gpu::Device device({.name_contains = config.device, .validation = config.has_validation});
    log::info("device", {{"name", device.info().name}, {"driver", device.info().driver}});
    const auto progress = [&](const std::string& done) {
        std::cerr << '\r' << done << "   " << std::flush;
        return signals.wait(std::chrono::milliseconds(0));
    };
    const bool is_done = channel::record_offline(device, config, job, progress);
    std::cerr << '\n';
    if (!is_done) {
        std::cerr << "interrupted: the frames so far are recorded\n";
        return kInterrupted;
    }
    std::cout << job.out.string() << '\n';
    return kOk;
}

/// What went wrong may be told in names of a scene's file.
void complain(std::string_view problem) {
    constexpr std::size_t kMaxBytes = 8192; // more than any message of ours
    std::cerr << "fieldcast-server: " << printable(problem, kMaxBytes) << '\n';
}

int start(int argc, char** argv) {
    const StopSignals signals; // before any thread exists
    const ops::Invocation invocation = ops::read_flags(argc, argv);
    for (const std::string& problem : invocation.problems) {
        complain(problem);
    }
    std::cout << invocation.text;
    if (!invocation.problems.empty()) {
        std::cerr << "fieldcast-server --help tells the flags\n";
        return kUserError;
    }
    switch (invocation.kind) {
    case ops::Invocation::Kind::kPrint:
        return kOk;
    case ops::Invocation::Kind::kCheck:
        std::cout << "the configuration is fine\n";
        return kOk;
    case ops::Invocation::Kind::kHealth:
        return probe(invocation.health);
    case ops::Invocation::Kind::kRender:
        return render(invocation.config, invocation.job, signals);
    case ops::Invocation::Kind::kRecord:
        return record(invocation.config, invocation.record_job, signals);
    case ops::Invocation::Kind::kInspect:
        std::cout << ops::inspect(invocation.inspect_job);
        return kOk;
    case ops::Invocation::Kind::kServe:
        break;
    }
    return run(invocation.config, signals);
}

} // namespace

int main(int argc, char** argv) {
    try {
        return start(argc, argv);
    } catch (const UserError& error) {
        complain(error.what());
        return kUserError;
    } catch (const std::exception& error) {
        complain(error.what());
        return kMachineFailed;
    }
}
