// SPDX-License-Identifier: Apache-2.0
#include "bench/speed/codecs_run.h"

#include "bench/interrupt.h"
#include "bench/progress.h"
#include "core/image/metrics.h"
#include "core/image/packing.h"
#include "core/lightfield/normal_precision.h"
#include "core/wire/base_view.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLight = "light";
constexpr const char* kView = "view";
const Coding kCoarseNormals{"zstd, oct2x8", {Codec::kZstdFiltered, 0}};

std::string name_of(PlaneSemantic semantic) {
    return semantic == PlaneSemantic::kColour ? kView : std::string(word_of(semantic));
}

/// Whether this coding applies to planes of a source frame, not only to views.
bool is_for_planes(const Coding& coding) {
    return carries(coding.encoding.codec, PlaneFormat::kR11G11B10F);
}

/// The corners of a grid, an inner view, and the base view of prediction.
std::vector<LatticePosition> chosen_positions(const ViewGrid& grid) {
    const std::uint32_t bottom = grid.rows - 1;
    const std::uint32_t right = grid.cols - 1;
    std::vector<LatticePosition> positions;
    for (const auto& [row, col] : {std::pair(0U, 0U), std::pair(0U, right), std::pair(bottom / 2, grid.cols / 2),
                                   std::pair(bottom, 0U), std::pair(bottom, right)}) {
        positions.push_back(lattice_position(grid, row, col));
    }
    positions.push_back(wire::base_position(positions.front()));
    std::ranges::sort(positions);
    const auto [first, last] = std::ranges::unique(positions);
    positions.erase(first, last);
    return positions;
}

RenderSettings render_settings(const LightFieldScene& scene, const CodecsSettings& settings) {
    RenderSettings render;
    render.exposure = settings.exposure;
    render.holes = parse_holes("all", scene.grid());
    return render;
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double discard_share(const Views& views) {
    double discards = 0.0;
    double pixels = 0.0;
    for (const View& view : views.views) {
        discards += view.discards.total();
        pixels += static_cast<double>(view.image.width_px) * view.image.height_px;
    }
    return discards / pixels;
}

/// Angles between the directions of two planes of normals, in degrees, pixel by pixel.
std::vector<double> angles_deg(const Plane& a, const Plane& b) {
    const std::vector<glm::vec3> of_a = image::unpack_plane(a);
    const std::vector<glm::vec3> of_b = image::unpack_plane(b);
    std::vector<double> angles;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        const double chord = glm::length(glm::dvec3(of_a[i]) - glm::dvec3(of_b[i]));
        angles.push_back(glm::degrees(2.0 * std::asin(std::min(chord / 2.0, 1.0))));
    }
    return angles;
}

} // namespace

CodecsRun::CodecsRun(const gpu::Device& device, LightFieldScene& scene, const CodecsSettings& settings)
    : scene_(scene), settings_(settings), codings_(all_codings(settings.qualities)),
      positions_(chosen_positions(scene.grid())), run_(device, scene, render_settings(scene, settings), true),
      planes_(device), surfaces_(device, scene.gpu_scene()), uncoded_(device, scene.gpu_scene()),
      coarse_(device, scene.gpu_scene()) {
    for (const Coding& coding : codings_) {
        const bool loses_light = is_lossy(coding.encoding.codec) && is_for_planes(coding);
        const bool loses_kinds = loses_light || coding.name == "zstd"; // one plane of light is lossy by itself
        const auto make_renderer = [&] { return std::make_unique<render::GridRenderer>(device, scene.gpu_scene()); };
        renderers_.push_back(loses_light ? make_renderer() : nullptr);
        merged_.push_back(loses_kinds ? make_renderer() : nullptr);
    }
}

void CodecsRun::run() {
    const InterruptGuard interrupt;
    Progress progress("frames", settings_.frames);
    for (std::uint32_t frame = 0; frame < settings_.frames; ++frame) {
        scene_.pose(frame);
        run_.render(frame, {LatticePosition{}}); // renders the source
        const SourceFrame source = run_.source().download(render::kSourceSemantics);
        if (frame + settings_.measured >= settings_.frames) {
            measure(source);
        }
        before_ = source;
        progress.add(1.0);
        if (interrupt.is_interrupted()) {
            throw Interrupted{"no results were written"};
        }
    }
}

void CodecsRun::measure(const SourceFrame& frame) {
    const Views uncoded = make_views(uncoded_, frame);
    for (std::size_t i = 0; i < codings_.size(); ++i) {
        if (is_for_planes(codings_[i])) {
            const SourceFrame decoded = measure_planes(frame, codings_[i]);
            if (renderers_[i]) {
                compare(make_views(*renderers_[i], decoded), uncoded, samples(kLight, codings_[i]));
            }
        }
        measure_views(uncoded, codings_[i]);
    }
    measure_coarse_normals(frame, uncoded);
    measure_total_light(frame, uncoded);
    views_before_ = uncoded;
}

SourceFrame CodecsRun::measure_planes(const SourceFrame& frame, const Coding& coding) {
    SourceFrame decoded = frame;
    CodedPlane light;
    for (Plane& plane : decoded.planes) {
        if (!carries(coding.encoding.codec, plane.format)) {
            continue;
        }
        CodedPlane coded = code_plane(plane, coding, {.before = before_.find(plane.semantic)},
                                      frame.header.settings.exposure);
        samples(name_of(plane.semantic), coding).add(coded);
        if (is_illumination(plane.semantic)) {
            light.bytes += coded.bytes;
            light.encode_ms += coded.encode_ms;
            light.decode_ms += coded.decode_ms;
        }
        plane = std::move(coded.decoded);
    }
    samples(kLight, coding).add(light);
    return decoded;
}

void CodecsRun::measure_coarse_normals(SourceFrame frame, const Views& uncoded) {
    const auto normal = std::ranges::find(frame.planes, PlaneSemantic::kNormal, &Plane::semantic);
    CodedPlane coded = code_plane(coarse_normals(*normal), kCoarseNormals, {}, frame.header.settings.exposure);
    const std::vector<double> angles = angles_deg(*normal, coded.decoded);
    mean_angle_deg_ = mean(angles);
    largest_angle_deg_ = std::max(largest_angle_deg_, *std::ranges::max_element(angles));
    Samples& of_normals = samples(name_of(PlaneSemantic::kNormal), kCoarseNormals);
    of_normals.add(coded);
    *normal = std::move(coded.decoded);
    compare(make_views(coarse_, frame), uncoded, of_normals);
}

void CodecsRun::measure_total_light(const SourceFrame& frame, const Views& uncoded) {
    const Plane light = run_.total_light();
    for (std::size_t i = 0; i < codings_.size(); ++i) {
        if (!is_for_planes(codings_[i]) || codings_[i].uses_key_frame) {
            continue;
        }
        SourceFrame received = frame;
        std::erase_if(received.planes, [](const Plane& plane) { return is_illumination(plane.semantic); });
        CodedPlane coded = code_plane(light, codings_[i], {}, frame.header.settings.exposure);
        samples(name_of(PlaneSemantic::kTotalLight), codings_[i]).add(coded);
        received.planes.push_back(std::move(coded.decoded));
        if (merged_[i]) {
            compare(make_views(*merged_[i], received), uncoded,
                    samples(name_of(PlaneSemantic::kTotalLight), codings_[i]));
        }
    }
}

void CodecsRun::measure_views(const Views& views, const Coding& coding) {
    const LatticePosition base = wire::base_position(positions_.front());
    const Plane& base_image = std::ranges::find(views.views, base, &View::position)->image;
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        const Plane& image = views.views[i].image;
        if (coding.uses_base && views.views[i].position == base) {
            continue; // it is not predicted
        }
        const Plane* const before = views_before_.views.empty() ? nullptr : &views_before_.views[i].image;
        if (coding.uses_key_frame && before == nullptr) {
            continue;
        }
        const CodedPlane coded = code_plane(image, coding, {.before = before, .base = &base_image},
                                             views.header.settings.exposure);
        Samples& view = samples(kView, coding);
        view.add(coded);
        if (is_lossy(coding.encoding.codec)) {
            view.ssim.push_back(image::ssim(image::display_image(coded.decoded), image::display_image(image)));
        }
    }
}

void CodecsRun::compare(const Views& views, const Views& uncoded, Samples& samples) const {
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        samples.ssim.push_back(image::ssim(image::display_image(views.views[i].image),
                                           image::display_image(uncoded.views[i].image)));
    }
    samples.discard_points.push_back(100.0 * (discard_share(views) - discard_share(uncoded)));
}

Views CodecsRun::make_views(render::GridRenderer& renderer, const SourceFrame& frame) {
    if (const auto taken = planes_.upload(frame); !taken) {
        throw std::runtime_error("source planes: " + taken.error().message);
    }
    if (frame.header.layer_count > 0) { // the surfaces of layers never travel
        surfaces_.render(planes_);
    }
    return renderer.render(planes_, scene_.request(positions_));
}

void CodecsRun::Samples::add(const CodedPlane& coded) {
    bytes.push_back(coded.bytes);
    encode_ms.push_back(coded.encode_ms);
    decode_ms.push_back(coded.decode_ms);
}

CodecsRun::Samples& CodecsRun::samples(const std::string& part, const Coding& coding) {
    return samples_[{part, coding.name}];
}

Json CodecsRun::row(const std::string& part, const Coding& coding, const Samples& samples) {
    const auto mean_or_null = [](const std::vector<double>& values) {
        return values.empty() ? Json() : Json(mean(values));
    };
    return {{"part", part},
            {"coding", coding.name},
            {"bytes", mean(samples.bytes)},
            {"encode_ms", median(samples.encode_ms)},
            {"decode_ms", median(samples.decode_ms)},
            {"ssim", mean_or_null(samples.ssim)},
            {"discard_points", mean_or_null(samples.discard_points)}};
}

Json CodecsRun::result() const {
    const Camera camera = run_.source().camera();
    Json json{{"source_size", to_string(Size{camera.width_px, camera.height_px})},
              {"guard_band_share", run_.guard_band().extra_share},
              {"exposure", run_.header().settings.exposure},
              {"measured_frames", settings_.measured},
              {"view_count", positions_.size()},
              {"coarse_normals_deg", {{"mean", mean_angle_deg_}, {"max", largest_angle_deg_}}}};
    std::vector<Coding> codings = codings_;
    codings.push_back(kCoarseNormals);
    std::vector<std::string> parts;
    for (const PlaneSemantic semantic : render::kSourceSemantics) {
        parts.push_back(name_of(semantic));
    }
    parts.insert(parts.begin() + 2, {kLight, name_of(PlaneSemantic::kTotalLight)});
    parts.emplace_back(kView);
    for (const std::string& part : parts) {
        for (const Coding& coding : codings) {
            const auto found = samples_.find({part, coding.name});
            if (found != samples_.end()) {
                json["rows"].push_back(row(part, coding, found->second));
            }
        }
    }
    return json;
}

} // namespace fieldcast::bench
