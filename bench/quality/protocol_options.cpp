// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/protocol_options.h"

#include <set>

namespace fieldcast::bench {

void add_protocol_options(CLI::App& command, ProtocolOptions& options) {
    command.add_option("--scene", options.scene, describe_scene_option())->capture_default_str();
    command.add_option("--protocol", options.protocol,
                       "Pictures to score: reduced (for two processor cores) or full (for a GPU).")
        ->capture_default_str();
    command.add_option("--size", options.size,
                       "Size of source and views in pixels, WIDTHxHEIGHT (default: the protocol's).");
    command.add_option("--frames", options.frames, "Frames to score, such as 11,29 (default: the protocol's).")
        ->delimiter(',')
        ->check(CLI::Range(0, 10'000));
    command.add_option("--spp", options.reference_samples,
                       "Samples per pixel of the references (default: the protocol's).")
        ->check(CLI::Range(1, 1 << 20));
    command.add_option("--references", options.references, "Folder of the references, which are kept for later runs.")
        ->capture_default_str();
    command.add_option("--device", options.device, "Part of the name of the Vulkan device.");
}

Protocol chosen_protocol(const ProtocolOptions& options) {
    Protocol protocol = find_protocol(options.protocol);
    if (!options.size.empty()) {
        protocol.size = parse_size("--size", options.size);
    }
    if (!options.frames.empty()) {
        const std::set<std::uint32_t> frames(options.frames.begin(), options.frames.end());
        protocol.frames.assign(frames.begin(), frames.end());
    }
    if (options.reference_samples > 0) {
        protocol.reference_samples = options.reference_samples;
    }
    return protocol;
}

std::string describe(const Protocol& protocol) {
    return protocol.name + " protocol: " + std::to_string(protocol.size.width_px) + "x" +
           std::to_string(protocol.size.height_px) + ", " + std::to_string(protocol.frames.size()) +
           (protocol.frames.size() == 1 ? " frame, " : " frames, ") +
           std::to_string(protocol.views.size()) + " views of 6x6, references of " +
           std::to_string(protocol.reference_samples) + " samples";
}

} // namespace fieldcast::bench
