// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench reference`: makes the references of `quality` and `grids` in advance.
#include "bench/commands.h"
#include "bench/quality/protocol_options.h"
#include "bench/quality/references.h"

#include <algorithm>
#include <iostream>

namespace fieldcast::bench {

namespace {

struct ReferenceOptions {
    ProtocolOptions protocol;
    bool has_temporal = false;
    bool has_light_field = false;
    bool is_half = false;
};

std::vector<PictureId> wanted_references(const ReferenceOptions& options, const Protocol& protocol) {
    std::vector<PictureId> wanted = protocol.pictures();
    if (options.has_temporal) {
        for (const PictureId& picture : protocol.pictures()) {
            wanted.push_back({picture.frame - 1, picture.position});
        }
    }
    if (options.has_light_field) {
        for (const LatticePosition position : lattice_positions(ViewGrid{})) {
            wanted.push_back({protocol.frames.back(), position});
        }
    }
    return wanted;
}

void run_reference(const ReferenceOptions& options) {
    const BenchmarkScene known = find_benchmark_scene(options.protocol.scene);
    const Protocol protocol = chosen_protocol(options.protocol);
    const gpu::Device device({.name_contains = options.protocol.device});
    LightFieldScene scene(device, {.file = known.file, .size = protocol.size});
    References references(device, scene, options.protocol.references,
                          options.is_half ? image::ExrPrecision::kHalf : image::ExrPrecision::kFloat);
    std::cout << known.title << ", " << describe(protocol) << std::endl;
    make_references(scene, references, wanted_references(options, protocol), protocol.reference_samples);
}

} // namespace

void add_reference_command(CLI::App& app) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App* command = app.add_subcommand(
        "reference", "Make the references of `quality` and `grids`; can be interrupted and continued.");
    add_protocol_options(*command, options->protocol);
    command->add_flag("--temporal", options->has_temporal,
                      "Also make references of the frames before the scored ones.");
    command->add_flag("--light-field", options->has_light_field,
                      "Also make references of all 36 views of the last frame.");
    command->add_flag("--half", options->is_half,
                      "Write 16-bit floats: files of half the size for sharing, with errors of 0.02 %.");
    command->callback([options] { run_reference(*options); });
}

} // namespace fieldcast::bench
