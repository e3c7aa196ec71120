// SPDX-License-Identifier: Apache-2.0
#include "client/console.h"
#include "client/interrupt.h"
#include "client/options.h"

#include "core/base/log.h"
#include "core/base/printable.h"
#include "core/image/atomic_file.h"

#include <cstdio>
#include <span>

namespace {

using namespace fieldcast;

using client::Interrupt;
using client::kExitFailed;
using client::kExitInterrupted;
using client::kExitUserError;

/// Prints an error. Its text may come from the server or from a scene that it sent, so it is made printable first.
void complain(std::string_view problem) {
    constexpr std::size_t kMaxBytes = 8192; // more than any message of ours
    std::fprintf(stderr, "fieldcast-client: %s\n", printable(problem, kMaxBytes).c_str());
}

int report(const client::Options& options, const client::play::PlayResult& result, bool was_interrupted) {
    if (result.summary.shown > 0) {
        std::fputs(to_table(result.summary).c_str(), stdout);
    }
    if (!options.json.empty()) {
        const std::string json = to_json(result.summary);
        image::write_file_atomically(options.json, std::as_bytes(std::span(json)));
    }
    if (was_interrupted) {
        return kExitInterrupted;
    }
    if (result.failure) {
        complain(result.failure->message);
        return result.failure->was_refused ? kExitUserError : kExitFailed;
    }
    return 0;
}

client::play::PlayResult play_or_fall_back(client::Options& options, const Interrupt& interrupt) {
    client::ProgressLine line;
    const auto on_progress = [&](const client::play::Progress& progress) { line.show(progress); };
    try {
        return client::play::play(options.play, on_progress, interrupt.token());
    } catch (const client::play::NoDeviceForViews& error) {
        if (!options.falls_back_to_views) {
            throw;
        }
        log::warn("no Vulkan device to make views; requesting finished views", {{"reason", error.what()}});
    }
    options.play.request.mode = DeliveryMode::kViews;
    if (options.play.request.adaptation) {
        options.play.request.adaptation->allows_scene = false;
    }
    for (client::play::Change& change : options.play.changes) {
        change.request.mode = DeliveryMode::kViews;
        change.request.adaptation = options.play.request.adaptation;
    }
    return client::play::play(options.play, on_progress, interrupt.token());
}

int run(client::Options options) {
    log::set_level(options.is_verbose ? log::Level::kDebug : log::Level::kWarn);
    const Interrupt interrupt;
    try {
        const client::play::PlayResult result = play_or_fall_back(options, interrupt);
        return report(options, result, interrupt.was_requested());
    } catch (const client::play::NoDeviceForViews& error) {
        complain(error.what());
        return kExitUserError;
    } catch (const UserError& error) {
        complain(error.what());
        return kExitUserError;
    } catch (const client::net::NetError& error) {
        complain(error.what());
        const int failed = error.is_denied() ? kExitUserError : kExitFailed;
        return interrupt.was_requested() ? kExitInterrupted : failed;
    } catch (const std::exception& error) {
        complain(error.what());
        return interrupt.was_requested() ? kExitInterrupted : kExitFailed;
    }
}

} // namespace

int main(int argc, char** argv) {
    const client::Invocation invocation = client::read_options(argc, argv);
    if (!invocation.options) {
        std::fputs(invocation.text.c_str(), invocation.exit_code == 0 ? stdout : stderr);
        return invocation.exit_code;
    }
    return run(*invocation.options);
}
