// SPDX-License-Identifier: Apache-2.0
// The reports of results: every section is there if its numbers are, and names from outside stay text.
#include "bench/pages/frame_page.h"
#include "bench/pages/grids_page.h"
#include "bench/pages/quality_page.h"
#include "bench/quality_table.h"
#include "tests/unit/report/html_check.h"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

namespace fieldcast::bench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Json quality_row(double rmse) {
    return {{"rmse", rmse},           {"ssim", 0.5},           {"relative_mse", 0.1},    {"rmse_holes", nullptr},
            {"rmse_without_noise", rmse}, {"ssim_without_noise", 0.5},
            {"rmse_reused", rmse},    {"rmse_border", rmse},   {"rmse_moving", nullptr}, {"frame_ms", nullptr},
            {"traced_share", 0.0125}, {"discard_share", 0.02}, {"hole_paths", 17}};
}

Json origin_of_result() {
    return {{"processor", "Any, 2 threads"},
            {"device", "a <device> & driver"},
            {"commit", "0123abc"},
            {"command", "fieldcast-bench \"<b>\""},
            {"scene", "<Hall>"},
            {"protocol", "reduced"},
            {"size", "32x18"},
            {"reference_samples", 64},
            {"rendered_views", "all"},
            {"exposure", 2.0}};
}

Json quality_result() {
    Json result = origin_of_result();
    result["rows"] = {{"1 spp", quality_row(0.4)}, {"<svgf>", quality_row(0.2)}, {"default", quality_row(0.1)}};
    return result;
}

void add_parts(Json& result) {
    for (auto& row : result["rows"]) {
        row["flip"] = 0.2;
        row["temporal"] = {{"warped_error", 0.01}, {"warped_error_excess", nullptr}, {"flicker", 0.002}};
        row["light_field"] = {{"angular_error", 0.03}, {"epi_ssim", 0.6},         {"refocus_rmse", 0.1},
                              {"refocus_ssim", 0.7},   {"rmse", {{"mean", 0.7}}}, {"ssim", {{"mean", 0.8}}}};
        for (int i = 0; i < 4; ++i) {
            row["light_field"]["views"].push_back({{"row", i / 2}, {"col", i % 2}, {"rmse", 0.1}, {"ssim", 0.9}});
        }
        row["light_field"]["refocus"] = {{{"depth_m", nullptr}, {"rmse", 0.1}, {"ssim", 0.5}},
                                         {{"depth_m", 2.5}, {"rmse", 0.2}, {"ssim", 0.5}}};
    }
}

TEST(QualityPage, SaysWhatWasMeasured) {
    const std::string html = quality_page(quality_result(), {}).html();
    EXPECT_EQ(test::html_problem(html), "");
    EXPECT_THAT(html, HasSubstr("<h1>&lt;Hall&gt;: quality of views</h1>"));
    EXPECT_THAT(html, HasSubstr("default has a root mean squared error of 0.1000, 0.25 of that of 1 spp"));
    EXPECT_THAT(html, HasSubstr("a &lt;device&gt; &amp; driver"));
    EXPECT_THAT(html, HasSubstr("0123abc"));
    for (const char* absent : {"Over time", "As a light field", "Pictures", "FLIP", "Holes", "Moving objects"}) {
        EXPECT_THAT(html, Not(HasSubstr(absent))) << absent;
    }
}

TEST(QualityPage, ShowsPartsAndPicturesThatAreThere) {
    Json result = quality_result();
    add_parts(result);
    const image::RgbF32 picture{32, 18, std::vector<glm::vec3>(32 * 18, glm::vec3(0.1F))};
    const std::string html =
        quality_page(result, {{29, {6, 6}},
                              {{"1 spp", picture}, {"<svgf>", picture}, {"default", picture}, {kReferenceName, picture}}})
            .html();
    EXPECT_EQ(test::html_problem(html), "");
    for (const char* present : {"Over time", "As a light field", "Pictures", "FLIP", "View (5, 5) of 6×6 in frame 29",
                                "error of &lt;svgf&gt;", "SSIM of each view, default", ">∞<", ">2.5 m<"}) {
        EXPECT_THAT(html, HasSubstr(present));
    }
    EXPECT_THAT(html, Not(HasSubstr("error of reference")));
}

TEST(QualityTable, HasALineForEachRow) {
    Json result = quality_result();
    add_parts(result);
    std::ostringstream stream;
    print_quality_table(stream, result);
    EXPECT_THAT(stream.str(), HasSubstr("1.25 %"));
    EXPECT_THAT(stream.str(), HasSubstr("SSIM of the views, default"));
    const auto rows = quality_csv_rows(result);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[2]["input"], "default");
    EXPECT_EQ(rows[2]["rmse"], 0.1); // not the light field's own
    EXPECT_EQ(rows[2]["epi_ssim"], 0.6);
    EXPECT_EQ(rows[2]["flip"], 0.2);
    EXPECT_EQ(rows[2]["protocol"], "reduced 32x18, references of 64 samples");
    for (const std::string& column : quality_columns()) {
        EXPECT_TRUE(rows[2].contains(column)) << column;
    }
}

TEST(QualityTable, HasTheColumnsOfTheCommittedResults) {
    std::string expected;
    for (const std::string& column : quality_columns()) {
        expected += (expected.empty() ? "" : ",") + column;
    }
    std::ifstream stream("bench/results/quality.csv");
    std::string line;
    std::getline(stream, line);
    EXPECT_EQ(line, expected);
}

TEST(FramePage, GroupsStagesAsThePaperDoes) {
    EXPECT_EQ(kind_of_stage("source_visibility"), "visibility");
    EXPECT_EQ(kind_of_stage("views_visibility"), "visibility");
    EXPECT_EQ(kind_of_stage("source_trace"), "path tracing");
    EXPECT_EQ(kind_of_stage("denoise"), "accumulate, denoise");
    EXPECT_EQ(kind_of_stage("denoise_holes"), "other hole filling");
    EXPECT_EQ(kind_of_stage("holes"), "hole paths");
    EXPECT_EQ(kind_of_stage("interleave"), "reprojection");
    EXPECT_EQ(kind_of_stage("shade_views"), "reprojection"); // which shades where views are not filtered
    EXPECT_EQ(kind_of_stage("tone_map"), "rest");
    Json result = origin_of_result();
    result.update({{"grid", "6x6"},
                   {"frames", 8},
                   {"frame_ms", 200.0},
                   {"hole_share", 0.02},
                   {"traced_share", 0.01},
                   {"ns_per_source_path", 24.0},
                   {"ns_per_hole_path", 23.0},
                   {"peak_rss_bytes", 1048576}});
    result["stages_ms"] = {{"source_trace", 100.0}, {"holes", 50.0}, {"<new>", 50.0}};
    const std::string html = frame_page(result).html();
    EXPECT_EQ(test::html_problem(html), "");
    EXPECT_THAT(html, HasSubstr("is 75 % of it"));
    EXPECT_THAT(html, HasSubstr("&lt;new&gt;"));
}

TEST(GridsPage, ShowsAllGridsInOneScale) {
    Json result = origin_of_result();
    result["preset"] = "default";
    result["frames"] = {29};
    result["ssim_lost"] = 0.0125;
    for (const auto& [name, ssim] : {std::pair("1x2", 0.75), std::pair("2x2", 0.5)}) {
        Json row = quality_row(0.1);
        row.update({{"grid", name}, {"frame_ms", 12.0}, {"ssim_min", ssim}});
        row["ssim"] = ssim;
        for (int i = 0; i < (name[0] - '0') * 2; ++i) {
            row["views"].push_back({{"frame", 29}, {"row", i / 2}, {"col", i % 2}, {"rmse", 0.1}, {"ssim", ssim}});
        }
        result["grids"].push_back(row);
    }
    const std::string html = grids_page(result).html();
    EXPECT_EQ(test::html_problem(html), "");
    EXPECT_THAT(html, HasSubstr("From 1x2 to 2x2 views, the mean structural similarity falls by 0.0125."));
    EXPECT_THAT(html, HasSubstr("<td style=\"--heat:100%\">0.750</td>"));
    EXPECT_THAT(html, HasSubstr("<td style=\"--heat:0%\">0.500</td>"));
}

} // namespace
} // namespace fieldcast::bench
