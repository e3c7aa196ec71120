// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/benchmark_scene.h"
#include "bench/quality/protocol.h"

#include <CLI/CLI.hpp>

namespace fieldcast::bench {

/// Options that all commands share that compare views with references.
struct ProtocolOptions {
    std::string scene = "atelier";
    std::string protocol = "reduced";
    std::string size; ///< empty: the protocol's
    std::string device;
    std::string references = ".cache/references";
    std::vector<std::uint32_t> frames;   ///< empty: the protocol's
    std::uint32_t reference_samples = 0; ///< 0: the protocol's
};

void add_protocol_options(CLI::App& command, ProtocolOptions& options);

/// The protocol with the changes of the command line. Throws UserError.
Protocol chosen_protocol(const ProtocolOptions& options);

/// A description in one line.
std::string describe(const Protocol& protocol);

} // namespace fieldcast::bench
