// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/printable.h"
#include "core/base/stop_signals.h"
#include "server/channel/channel_list.h"
#include "server/channel/offline_recording.h"
#include "server/command_line/flags.h"
#include "server/command_line/port_file.h"
#include "server/listener/descriptor.h"
#include "server/metrics/process_metrics.h"
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
constexpr int kDeaf = 3; // a supervisor restarts the server
constexpr int kInterrupted = 130;

constexpr std::chrono::milliseconds kPollInterval{100};
constexpr std::chrono::milliseconds kStartPollInterval{20}; // also the largest delay that it adds to a start
constexpr std::chrono::seconds kDrainLimit{8}; // the spread of GoingAway, its deadline, and some room

constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8"; // of metrics::Page

/// Adds metrics of the process: its version, memory, processor time, threads and descriptors.
void collect_process(metrics::Page& page) {
    page.add_gauge({"fieldcast_build_info", "Always 1, with the version as label."}, {{"version", FIELDCAST_VERSION}},
                   1.0);
    metrics::add_process_metrics(page);
}

/// Pages of the metrics endpoint.
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

/// The metrics endpoint and its port file, if --metrics-listen is given.
class MetricsServer {
public:
    MetricsServer(const config::Config& config, const access::Gate& gate, metrics::Registry& registry)
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
    std::optional<command_line::PortFile> port_file_;
};

/// Records the timings of every frame of every channel, with or without clients.
void record_frames(const std::vector<std::shared_ptr<feed::Feed>>& feeds, timing::TimingRecorder& recorder) {
    for (const auto& feed : feeds) {
        feed->observe([&recorder, name = feed->info().name](const feed::FramePtr& frame) {
            recorder.add(session::made_frame(name, *frame));
        });
    }
}

/// Why the server ends: the reason for clients, and the exit code.
struct Ending {
    const char* reason;
    int exit_code;
};

/// Waits for a signal, a failed channel, or a port that no longer answers.
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

/// Drains until all clients have left, a second signal, or the time limit.
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

/// All parts of a running server, in the order in which they start.
class Service {
public:
    /// Ready to serve when constructed. `config` must outlive it.
    explicit Service(const config::Config& config)
        : recorder_(config.timing_files.any() ? std::make_unique<timing::TimingRecorder>(config.timing_files)
                                              : nullptr),
          channels_(config.rendering, *registry_),
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
    const std::unique_ptr<timing::TimingRecorder> recorder_; ///< before the channels, so that it outlives them
    const channel::ChannelList channels_;
    service::GrpcServer server_;
    const MetricsServer metrics_server_;
};

/// Starts the service in a thread of its own, while this thread waits for signals. The first signal ends the process at
/// any point of the start (reading a scene, compiling kernels, rendering a frame). There are no clients yet.
std::unique_ptr<Service> start_unless_stopped(const config::Config& config, const StopSignals& signals) {
    std::packaged_task<std::unique_ptr<Service>()> start([&config] { return std::make_unique<Service>(config); });
    auto started = start.get_future();
    const std::jthread thread(std::move(start));
    while (started.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        if (signals.wait(kStartPollInterval)) {
            log::info("stopped while starting", {});
            std::_Exit(kOk); // without destructors, because the other thread is still running
        }
    }
    return started.get();
}

int run(const config::Config& config, const StopSignals& signals) {
    log::set_format(config.log_format);
    log::set_level(config.log_level);
    listener::raise_descriptor_limit();
    const auto service = start_unless_stopped(config, signals);
    service::GrpcServer& server = service->server();
    std::optional<command_line::PortFile> port_file;
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

/// Renders to files instead of serving. Several channels get one folder each.
int render(const config::Config& config, const channel::OfflineJob& job, const StopSignals& signals) {
    log::set_format(config.log_format);
    log::set_level(config.log_level);
    const gpu::Device device({.name_contains = config.rendering.device, .validation = config.rendering.has_validation});
    log::info("device", {{"name", device.info().name}, {"driver", device.info().driver}});
    for (const channel::ChannelChoice& choice : config.rendering.channels) {
        channel::OfflineJob own = job;
        if (config.rendering.channels.size() > 1) {
            own.out /= choice.name;
        }
        const auto progress = [&](const std::string& done) {
            std::cerr << '\r' << printable(choice.name, 256) << ": " << done << "   " << std::flush;
            return signals.wait(std::chrono::milliseconds(0));
        };
        const bool is_done = channel::render_offline(device, config.rendering, choice, own, progress);
        std::cerr << '\n';
        if (!is_done) {
            std::cerr << "interrupted: the files written so far are complete\n";
            return kInterrupted;
        }
        std::cout << own.out.string() << '\n';
    }
    return kOk;
}

/// Makes a recording instead of serving.
int record(const config::Config& config, const channel::RecordJob& job, const StopSignals& signals) {
    log::set_format(config.log_format);
    log::set_level(config.log_level);
    const gpu::Device device({.name_contains = config.rendering.device, .validation = config.rendering.has_validation});
    log::info("device", {{"name", device.info().name}, {"driver", device.info().driver}});
    const auto progress = [&](const std::string& done) {
        std::cerr << '\r' << done << "   " << std::flush;
        return signals.wait(std::chrono::milliseconds(0));
    };
    const bool is_done = channel::record_offline(device, config.rendering, job, progress);
    std::cerr << '\n';
    if (!is_done) {
        std::cerr << "interrupted: the recording contains the frames so far\n";
        return kInterrupted;
    }
    std::cout << job.out.string() << '\n';
    return kOk;
}

/// Prints an error. It may quote names from a scene file, so it is made printable first.
void complain(std::string_view problem) {
    constexpr std::size_t kMaxBytes = 8192; // more than any message of ours
    std::cerr << "fieldcast-server: " << printable(problem, kMaxBytes) << '\n';
}

int start(int argc, char** argv) {
    const StopSignals signals; // before any thread exists
    const command_line::Invocation invocation = command_line::read_flags(argc, argv);
    for (const std::string& problem : invocation.problems) {
        complain(problem);
    }
    std::cout << invocation.text;
    if (!invocation.problems.empty()) {
        std::cerr << "fieldcast-server --help lists all flags\n";
        return kUserError;
    }
    switch (invocation.kind) {
    case command_line::Invocation::Kind::kPrint:
        return kOk;
    case command_line::Invocation::Kind::kCheck:
        std::cout << "the configuration is valid\n";
        return kOk;
    case command_line::Invocation::Kind::kHealth:
        return probe(invocation.health);
    case command_line::Invocation::Kind::kRender:
        return render(invocation.config, invocation.job, signals);
    case command_line::Invocation::Kind::kRecord:
        return record(invocation.config, invocation.record_job, signals);
    case command_line::Invocation::Kind::kInspect:
        std::cout << command_line::inspect(invocation.inspect_job);
        return kOk;
    case command_line::Invocation::Kind::kServe:
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
