// SPDX-License-Identifier: Apache-2.0
#include "server/channel/offline.h"

#include "core/image/image_file.h"
#include "core/image/metrics.h"

#include <algorithm>
#include <cstdio>

namespace fieldcast::channel {

namespace {

feed::Demand whole_grid(const feed::ChannelInfo& info, bool wants_source) {
    feed::Demand demand;
    if (wants_source) {
        for (const PlaneSemantic semantic : render::kSourceSemantics) {
            demand.planes.push_back({semantic, Codec::kRaw});
        }
    }
    const wire::ViewFormat format{.geometry = info.largest_grid.geometry,
                                  .fovy_rad = info.fovy_rad,
                                  .width_px = info.source_width_px,
                                  .height_px = info.source_height_px};
    demand.views.push_back({format, lattice_positions(info.largest_grid)});
    return demand;
}

/// Views are sorted by position, which for one grid is the row-by-row order of the files.
void write(const std::filesystem::path& folder, const ViewGrid& grid, const RenderedFrame& frame,
           const image::LightFieldProducts& products) {
    const image::LightFieldPicture picture{grid, frame.views.front().views, frame.source ? &*frame.source : nullptr};
    image::write_light_field(folder, picture, products);
}

std::string view_name(const ViewGrid& grid, std::size_t index) {
    return "view_r" + std::to_string(index / grid.cols) + "_c" + std::to_string(index % grid.cols);
}

/// An 8-bit picture of linear radiance: clamp and sRGB curve.
Plane display_plane(const image::RgbF32& linear, float exposure) {
    const image::RgbF32 shown = image::display_image(linear, exposure);
    Plane plane{PlaneSemantic::kColour, PlaneFormat::kRgb8, linear.width_px, linear.height_px, {}};
    plane.bytes.reserve(plane_bytes(plane.format, plane.width_px, plane.height_px));
    for (const glm::vec3& pixel : shown.pixels) {
        for (int c = 0; c < 3; ++c) {
            plane.bytes.push_back(static_cast<std::byte>(pixel[c] * 255.0F + 0.5F));
        }
    }
    return plane;
}

bool write_references(FrameRenderer& renderer, const FrameMoment& moment, const OfflineJob& job,
                      const OfflineProgress& progress) {
    const ViewGrid& grid = renderer.info().largest_grid;
    const auto positions = lattice_positions(grid);
    Views views;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const auto report = [&](std::uint32_t samples) {
            return progress("view " + std::to_string(i + 1) + " of " + std::to_string(positions.size()) + ", " +
                            std::to_string(samples) + " samples");
        };
        const auto linear = renderer.path_trace(moment, positions[i], job.reference_samples, report);
        if (!linear) {
            return false;
        }
        std::filesystem::create_directories(job.out);
        image::write_exr(job.out / (view_name(grid, i) + ".exr"), *linear);
        views.views.push_back({positions[i], display_plane(*linear, renderer.exposure()), {}});
    }
    image::LightFieldProducts products = job.products;
    products.source_exr = false; // references have no source
    image::write_light_field(job.out, {grid, views, nullptr}, products);
    return true;
}

} // namespace

FrameMoment offline_moment(const Settings& settings, std::uint32_t frame) {
    const double time_s = settings.fixed_time_s.value_or(frame / static_cast<double>(settings.frames_per_second));
    return {.scene_time_ns = static_cast<std::int64_t>(time_s * 1e9), .cut = frame == 0, .noise_frame = frame};
}

bool render_offline(const gpu::Device& device, const Settings& settings, const ChannelChoice& channel,
                    const OfflineJob& job, const OfflineProgress& progress) {
    FrameRenderer renderer(device, settings, channel);
    const std::uint32_t last = job.frame_count - 1;
    if (job.reference_samples > 0) {
        return write_references(renderer, offline_moment(settings, last), job, progress);
    }
    const ViewGrid& grid = renderer.info().largest_grid;
    const feed::Demand demand = whole_grid(renderer.info(), job.products.source_exr);
    for (std::uint32_t frame = 0; frame <= last; ++frame) {
        if (progress("frame " + std::to_string(frame + 1) + " of " + std::to_string(job.frame_count))) {
            return false;
        }
        const RenderedFrame rendered = renderer.render(frame + 1, offline_moment(settings, frame), demand);
        if (job.writes_every_frame) {
            std::array<char, 16> name{};
            std::snprintf(name.data(), name.size(), "frame_%06u", frame);
            write(job.out / name.data(), grid, rendered, job.products);
        } else if (frame == last) {
            write(job.out, grid, rendered, job.products);
        }
    }
    return true;
}

} // namespace fieldcast::channel
