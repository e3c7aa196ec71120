// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench trace`: traces the same rays with our kernels and with Embree; medians of interleaved repetitions.
#include "bench/commands.h"
#include "bench/measure.h"
#include "bench/speed/device_tracer.h"
#include "bench/speed/rays.h"
#include "core/base/error.h"
#include "core/scene/gltf/loader.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <thread>

namespace fieldcast::bench {

namespace {

struct TraceOptions {
    std::string scene = "../shared/scenes/sponza/Sponza.gltf";
    std::string size = "1280x720";
    std::string device;
    std::string traversal = "auto";
    std::string json;
    std::uint32_t repeat = 7;
    std::uint32_t threads = std::max(1U, std::thread::hardware_concurrency());
    double time_s = 0.0;
};

/// One kind of rays, and its target.
struct RayKind {
    const char* name;
    std::span<const shared::TraceRay> rays;
    bool any;      ///< any hit ends a ray
    double target; ///< ratio of our rays per second to Embree's, on software Vulkan
};

/// One tracer, with the seconds of each repetition.
struct Contender {
    std::string name;
    DeviceTracer* tracer;
    std::vector<double> seconds{};
};

struct KindResult {
    double embree_mrays_per_s = 0.0;
    std::vector<double> mrays_per_s; ///< one per contender
    double agreement = 0.0;          ///< share of rays for which the first contender and Embree hit the same
};

double agreement(const DeviceRays& rays, std::span<const shared::TraceHit> hits, std::span<const float> blocked,
                 bool any) {
    std::size_t same = 0;
    if (any) {
        const std::vector<float> ours = rays.transmittances();
        for (std::size_t i = 0; i < ours.size(); ++i) {
            same += ours[i] == blocked[i] ? 1U : 0U;
        }
    } else {
        const std::vector<shared::TraceHit> ours = rays.hits();
        for (std::size_t i = 0; i < ours.size(); ++i) {
            const bool is_same = ours[i].instance == hits[i].instance && ours[i].primitive == hits[i].primitive;
            const bool both_miss = ours[i].instance == scene::kNone && hits[i].instance == scene::kNone;
            same += is_same || both_miss ? 1U : 0U;
        }
    }
    return static_cast<double>(same) / static_cast<double>(std::max<std::size_t>(rays.count(), 1));
}

KindResult run_kind(const gpu::Device& device, const RayKind& kind, std::span<Contender> contenders,
                    const EmbreeTracer& embree, const TraceOptions& options) {
    const DeviceRays rays(device, kind.rays);
    std::vector<shared::TraceHit> hits(kind.rays.size());
    std::vector<float> transmittances(kind.rays.size());
    std::vector<double> embree_seconds;
    const auto trace = [&](Contender& contender) {
        return kind.any ? contender.tracer->trace_any(rays) : contender.tracer->trace_closest(rays);
    };
    for (std::uint32_t repetition = 0; repetition <= options.repeat; ++repetition) {
        const double seconds = kind.any ? embree.trace_any(kind.rays, transmittances, options.threads)
                                        : embree.trace_closest(kind.rays, hits, options.threads);
        embree_seconds.push_back(seconds);
        for (Contender& contender : contenders) {
            contender.seconds.push_back(trace(contender));
        }
        if (repetition == 0) { // warm-up: compiles kernels and fills caches
            embree_seconds.clear();
            std::for_each(contenders.begin(), contenders.end(), [](Contender& c) { c.seconds.clear(); });
        }
    }
    const double mrays = static_cast<double>(kind.rays.size()) * 1e-6;
    KindResult result{mrays / median(embree_seconds), {}, 0.0};
    for (const Contender& contender : contenders) {
        result.mrays_per_s.push_back(mrays / median(contender.seconds));
    }
    trace(contenders[0]);
    result.agreement = agreement(rays, hits, transmittances, kind.any);
    std::for_each(contenders.begin(), contenders.end(), [](Contender& c) { c.seconds.clear(); });
    return result;
}

void print_table(std::span<const RayKind> kinds, std::span<const KindResult> results,
                 std::span<const Contender> contenders, bool has_targets) {
    std::cout << std::fixed << std::setprecision(2);
    std::cout << "rays         Mray/s    Embree     ratio    target   same hits\n";
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const double ratio = results[i].mrays_per_s[0] / results[i].embree_mrays_per_s;
        std::cout << std::left << std::setw(9) << kinds[i].name << std::right << std::setw(10)
                  << results[i].mrays_per_s[0] << std::setw(10) << results[i].embree_mrays_per_s << std::setw(10)
                  << ratio << std::setw(10) << (has_targets ? kinds[i].target : 0.0) << std::setw(10)
                  << 100.0 * results[i].agreement << " %\n";
    }
    for (std::size_t c = 1; c < contenders.size(); ++c) {
        std::cout << contenders[c].name << ", Mray/s:";
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            std::cout << "  " << kinds[i].name << ' ' << results[i].mrays_per_s[c] << " ("
                      << results[i].mrays_per_s[c] / results[i].mrays_per_s[0] << " of opaque)";
        }
        std::cout << '\n';
    }
}

nlohmann::ordered_json to_json(const std::string& device, std::span<const RayKind> kinds,
                               std::span<const KindResult> results, std::span<const Contender> contenders) {
    nlohmann::ordered_json json;
    json["device"] = device;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const KindResult& result = results[i];
        json["rays"][kinds[i].name] = {{"mrays_per_s", result.mrays_per_s[0]},
                                       {"embree_mrays_per_s", result.embree_mrays_per_s},
                                       {"ratio", result.mrays_per_s[0] / result.embree_mrays_per_s},
                                       {"same_hits", result.agreement}};
        for (std::size_t c = 1; c < contenders.size(); ++c) {
            json["beside"][contenders[c].name][kinds[i].name] = {{"mrays_per_s", result.mrays_per_s[c]}};
        }
    }
    return json;
}

void run_trace(const TraceOptions& options) {
    const Size size = parse_size("--size", options.size);
    const gpu::Device device({.name_contains = options.device});
    const scene::Traversal traversal = scene::choose_traversal(device, options.traversal);
    const scene::Scene scene = scene::load_scene(options.scene);
    const scene::CameraNode* camera = scene::find_camera(scene);
    if (camera == nullptr) {
        throw UserError(options.scene + ": has no camera");
    }
    const auto time_ns = static_cast<std::int64_t>(std::llround(options.time_s * 1e9));
    const scene::ScenePose pose = scene::pose_scene(scene, time_ns);
    const EmbreeTracer embree(scene, pose);
    const RaySets sets = make_rays(scene, pose, *camera, embree, size.width_px, size.height_px);
    const scene::Acceleration flat(device, scene, pose, traversal);
    const scene::Acceleration shared_meshes(device, scene, pose, traversal, {.share_meshes = true});
    scene::GpuScene gpu_scene(device, scene, traversal);
    gpu_scene.pose(time_ns, true);
    DeviceTracer opaque(device, flat, traversal);
    DeviceTracer instanced(device, shared_meshes, traversal);
    DeviceTracer alpha(device, gpu_scene);
    std::vector<Contender> contenders{{"opaque", &opaque}, {"alpha_tests", &alpha}, {"instancing", &instanced}};
    const std::vector<RayKind> kinds{{"primary", sets.primary, false, 0.38},
                                     {"bounce", sets.bounce, false, 0.38},
                                     {"shadow", sets.shadow, true, 0.33}};
    std::cout << device.info().name << ", " << options.threads << " threads for Embree\n"
              << options.scene << ", " << flat.statistics().triangles << " triangles, built in "
              << std::llround(flat.statistics().build_ms) << " ms\n";
    std::vector<KindResult> results;
    for (const RayKind& kind : kinds) {
        results.push_back(run_kind(device, kind, contenders, embree, options));
    }
    print_table(kinds, results, contenders, device.info().is_cpu);
    if (!options.json.empty()) {
        write_json(options.json, to_json(device.info().name, kinds, results, contenders));
    }
}

} // namespace

void add_trace_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("trace", "Rays per second of the traversal kernels against Embree.");
    auto options = std::make_shared<TraceOptions>();
    command->add_option("--scene", options->scene, "glTF file.")->capture_default_str();
    command->add_option("--size", options->size, "Size of the image in pixels, WIDTHxHEIGHT.")->capture_default_str();
    command->add_option("--time", options->time_s, "Time in the scene, in seconds.")->capture_default_str();
    command->add_option("--repeat", options->repeat, "Number of timed repetitions.")->check(CLI::Range(1, 1000));
    command->add_option("--threads", options->threads, "Number of threads for Embree.")->check(CLI::Range(1, 1024));
    command->add_option("--device", options->device, "Part of the name of the Vulkan device; the first match is used.");
    command->add_option("--traversal", options->traversal, "Ray traversal: auto, bvh or rayquery.")
        ->capture_default_str();
    command->add_option("--json", options->json, "Also write the results to this JSON file.");
    command->callback([options] { run_trace(*options); });
}

} // namespace fieldcast::bench
