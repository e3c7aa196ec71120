// SPDX-License-Identifier: Apache-2.0
#include "bench/pages/frame_page.h"

#include "bench/pages/result_page.h"
#include "core/lightfield/vocabulary.h"
#include "report/chart.h"

#include <algorithm>
#include <array>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;

/// A kind of work, and its time in ms in the paper's figure 3: Sponza, 6×6 views of 1280×720, RTX 3090, 54 ms in all.
/// The time is 0 for kinds that the figure does not show.
struct Kind {
    const char* name;
    std::size_t series;
    double paper_ms;
};

constexpr std::array<Kind, 8> kKinds{{{"visibility", 7, 10.1},
                                      {"path tracing", 1, 22.0},
                                      {"accumulate, denoise", 2, 3.5},
                                      {"reprojection", 3, 2.5},
                                      {"hole paths", 4, 16.0},
                                      {"other hole filling", 6, 0.0},
                                      {"layers", 0, 0.0},
                                      {"rest", 5, 0.0}}};

report::Markup breakdown(const Json& result) {
    report::Stack ours{.label = result["scene"].get<std::string>() + ", " + result["grid"].get<std::string>() +
                                " views of " + result["size"].get<std::string>(),
                       .total = report::fixed(result["frame_ms"].get<double>(), 0) + " ms",
                       .parts = {}};
    report::Stack paper{.label = "Paper: Sponza, 6x6 views of 1280x720, RTX 3090", .total = "54 ms", .parts = {}};
    for (const Kind& kind : kKinds) {
        double ms = 0.0;
        for (const auto& [stage, time] : result["stages_ms"].items()) {
            ms += kind_of_stage(stage) == kind.name ? time.get<double>() : 0.0;
        }
        if (ms > 0.0) {
            ours.parts.push_back({kind.name, ms, kind.series});
        }
        if (kind.paper_ms > 0.0) {
            paper.parts.push_back({kind.name, kind.paper_ms, kind.series});
        }
    }
    return report::stacked_bars("Shares of a frame", {ours, paper});
}

report::Markup stages(const Json& result) {
    report::BarChart chart{
        .title = "Median time of each stage", .note = "in order", .digits = 1, .unit = " ms", .bars = {}};
    for (const auto& [stage, ms] : result["stages_ms"].items()) {
        chart.bars.push_back({.label = stage, .value = ms.get<double>()});
    }
    return report::bar_chart(chart);
}

double path_share(const Json& result) {
    double ms = 0.0;
    for (const auto& [stage, time] : result["stages_ms"].items()) {
        const std::string kind = kind_of_stage(stage);
        ms += kind == "path tracing" || kind == "hole paths" ? time.get<double>() : 0.0;
    }
    return ms / std::max(1e-9, result["frame_ms"].get<double>());
}

std::string percent_text(const Json& share) {
    return report::fixed(100.0 * share.get<double>(), 2) + " %";
}

} // namespace

std::string kind_of_stage(const std::string& stage) {
    const auto contains = [&](std::string_view part) { return stage.find(part) != std::string::npos; };
    if (stage == "holes") {
        return "hole paths";
    }
    if (contains("holes")) {
        return "other hole filling";
    }
    if (contains("visibility") || contains("surfaces")) {
        return "visibility";
    }
    if (contains("trace")) {
        return "path tracing";
    }
    const bool is_denoiser = std::ranges::any_of(kAll<Denoiser>, [&](Denoiser denoiser) {
        const std::string_view word = word_of(denoiser); // stages are named after it: "svgf_atrous" of svgf and svgf+
        return contains(word.substr(0, word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789")));
    });
    if (contains("temporal") || contains("denoise") || is_denoiser || stage == "pack") {
        return "accumulate, denoise";
    }
    if (contains("reproject") || stage == "interleave" || stage == "shade_views") {
        return "reprojection";
    }
    return stage == "layers" ? "layers" : "rest";
}

report::Page frame_page(const Json& result) {
    const double frame_ms = result["frame_ms"].get<double>();
    report::Page page(result["scene"].get<std::string>() + ": time of the stages of a frame",
                      "A frame takes " + report::fixed(frame_ms, 0) +
                          " ms; tracing paths of the source and of holes " + "is " +
                          report::fixed(100.0 * path_share(result), 0) +
                          " % of it. In the paper it is 70 %. Compare shares, not times: the machines differ.");
    page.add_section("The frame", breakdown(result));
    page.add_section("Stages", stages(result));
    page.add_section(
        "Holes",
        report::definitions({{"not reusable", percent_text(result["hole_share"]) + " of the synthesised pixels"},
                             {"path traced", percent_text(result["traced_share"]) + " of the synthesised pixels"},
                             {"one source path", report::fixed(result["ns_per_source_path"].get<double>(), 0) + " ns"},
                             {"one hole path", report::fixed(result["ns_per_hole_path"].get<double>(), 0) + " ns"}}));
    page.add_section("Measurement",
                     origin(result, {{"frames", result["frames"].dump() + " after warm-up, medians of each stage"},
                                     {"peak memory",
                                      report::fixed(result["peak_rss_bytes"].get<double>() / 1048576.0, 0) + " MiB"}}));
    return page;
}

} // namespace fieldcast::bench
