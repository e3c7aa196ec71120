// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "report/chart.h"
#include "report/page.h"
#include "report/picture.h"
#include "tests/unit/report/html_check.h"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>

namespace fieldcast::report {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kHostile = "<script src=\"http://evil.example/a.js\">'&'</script>";

std::string base64_of(std::string_view text) {
    return base64(std::as_bytes(std::span(text)));
}

// Test vectors of RFC 4648, section 10.
TEST(Markup, EncodesBase64) {
    EXPECT_EQ(base64_of(""), "");
    EXPECT_EQ(base64_of("f"), "Zg==");
    EXPECT_EQ(base64_of("fo"), "Zm8=");
    EXPECT_EQ(base64_of("foo"), "Zm9v");
    EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
    EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64_of("\xFB\xFF"), "+/8=");
}

TEST(Markup, EscapesText) {
    EXPECT_EQ(escaped("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
    EXPECT_EQ(escaped(std::string("6×6\n\0\x1B[31m", 11)), "6×6\n[31m");
    EXPECT_EQ(element("p", "a", text("<b>")).html, "<p class=\"a\">&lt;b&gt;</p>\n");
    EXPECT_EQ(element("p", "", text("")).html, "<p></p>\n");
}

TEST(BarChart, ScalesBarsToTheLongestOrTheFullOne) {
    const Markup chart = bar_chart({.title = "RMSE", .digits = 2, .bars = {{"a", 0.5}, {"b", 0.25, true}, {"c", {}}}});
    EXPECT_THAT(chart.html, HasSubstr("width=\"100.00%\""));
    EXPECT_THAT(chart.html, HasSubstr("class=\"bar ours\" x=\"0\" y=\"2\" width=\"50.00%\""));
    EXPECT_THAT(chart.html, HasSubstr("c: –"));
    const Markup full = bar_chart({.title = "SSIM", .digits = 2, .full = 1.0, .bars = {{"a", 0.5}}});
    EXPECT_THAT(full.html, HasSubstr("width=\"50.00%\""));
    const Markup negative = bar_chart({.title = "Excess", .digits = 2, .bars = {{"a", -0.5}}});
    EXPECT_THAT(negative.html, HasSubstr("width=\"0.00%\""));
    EXPECT_THAT(negative.html, HasSubstr("-0.50"));
}

TEST(StackedBars, AreAsLongAsTheirParts) {
    const Markup chart = stacked_bars("Frame", {{"ours", "100 ms", {{"trace", 75.0, 1}, {"rest", 25.0, 2}}}});
    EXPECT_THAT(chart.html, HasSubstr("x=\"0.00%\" y=\"0\" width=\"75.00%\""));
    EXPECT_THAT(chart.html, HasSubstr("x=\"75.00%\" y=\"0\" width=\"25.00%\""));
    EXPECT_THAT(chart.html, HasSubstr(">75 %<"));
}

TEST(LineChart, CoversItsValues) {
    const Markup chart =
        line_chart({.title = "SSIM", .digits = 2, .points = {"3x3", "6x6"}, .lines = {{"ours", {0.8, 0.7}, 0}}});
    // The axis goes 15 % of the range beyond: 0.685 … 0.815 between 176 and 14 px.
    EXPECT_THAT(chart.html, HasSubstr("cx=\"16.00%\" cy=\"32.7\""));
    EXPECT_THAT(chart.html, HasSubstr("cx=\"92.00%\" cy=\"157.3\""));
    EXPECT_NO_THROW(line_chart({.title = "one", .points = {"3x3"}, .lines = {{"ours", {0.8}, 0}}}));
    EXPECT_THROW(line_chart({.title = "none", .points = {"a", "b"}, .lines = {{"ours", {0.8}, 0}}}), std::logic_error);
}

TEST(HeatMap, HasTheShapeOfTheGrid) {
    const Markup map = heat_map({.title = "views", .cols = 2, .values = {0.0, 0.5, 1.0, 2.0}});
    EXPECT_THAT(map.html,
                HasSubstr("<tr><td style=\"--heat:0%\">0.000</td><td style=\"--heat:50%\">0.500</td></tr>\n<tr>"));
    EXPECT_THAT(map.html, HasSubstr("--heat:100%\">2.000"));
}

image::RgbF32 grey(std::uint32_t width, std::uint32_t height) {
    return {width, height, std::vector<glm::vec3>(std::size_t{width} * height, glm::vec3(0.0F))};
}

TEST(Crop, LiesWhereErrorsAreLargest) {
    image::RgbF32 errors = grey(100, 60);
    errors.pixels[55 * 100 + 95] = glm::vec3(-1.0F);
    EXPECT_EQ(worst_crop(errors, 20, 10), (Crop{80, 50, 20, 10}));
    EXPECT_EQ(worst_crop(errors, 320, 180), (Crop{0, 0, 100, 60}));
    EXPECT_EQ(worst_crop(grey(100, 60), 20, 10), (Crop{0, 0, 20, 10}));
    const image::RgbF32 part = cropped(errors, {95, 55, 2, 3});
    EXPECT_EQ(part.width_px, 2U);
    EXPECT_EQ(part.pixels, (std::vector<glm::vec3>{glm::vec3(-1.0F), {}, {}, {}, {}, {}}));
    EXPECT_THROW(cropped(errors, {90, 0, 20, 10}), std::logic_error);
}

TEST(ErrorMap, GrowsBrighterWithTheError) {
    image::RgbF32 errors = grey(3, 1);
    errors.pixels[1] = {0.3F, -0.3F, 0.0F}; // mean 0.2, half of the largest
    errors.pixels[2] = glm::vec3(9.0F);
    const image::RgbF32 map = error_map(errors, 0.4F);
    EXPECT_EQ(map.pixels[0], glm::vec3(0, 0, 4) / 255.0F);
    EXPECT_NEAR(map.pixels[1].r, 181.0F / 255.0F, 1e-5F); // half way between two control points, 140 and 222
    EXPECT_EQ(map.pixels[2], glm::vec3(252, 253, 191) / 255.0F);
}

TEST(Page, IsWellFormedAndAsksForNothing) {
    Page page(kHostile, kHostile);
    Markup content = paragraph(kHostile);
    content += definitions({{kHostile, kHostile}});
    content += table({.titles = {kHostile, "b"}, .rows = {{kHostile, kHostile}}, .highlighted = 0});
    content += bar_chart({.title = kHostile, .note = kHostile, .unit = kHostile, .bars = {{kHostile, 1.0}}});
    content += stacked_bars(kHostile, {{kHostile, kHostile, {{kHostile, 1.0, 0}}}});
    content += line_chart(
        {.title = kHostile, .note = kHostile, .points = {kHostile}, .lines = {{kHostile, {1.0}, 0}, {"b", {2.0}, 1}}});
    content += heat_map({.title = kHostile, .values = {1.0}});
    content += compare_pictures(page, {{kHostile, kHostile, grey(4, 3)}, {"b", "", grey(4, 3), true}});
    content += error_scale(0.25F);
    page.add_section(kHostile, content);
    const std::string html = page.html();
    EXPECT_EQ(test::html_problem(html), "");
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(html, HasSubstr("prefers-color-scheme: dark"));
    EXPECT_THAT(html, HasSubstr("name=\"viewport\""));
    EXPECT_THAT(html, HasSubstr("data:image/png;base64,iVBORw0KGgo")); // the first bytes of every PNG
}

TEST(HtmlCheck, FindsWhatItIsFor) {
    EXPECT_EQ(test::html_problem("<p>a<br><input type=\"radio\"></p>"), "");
    EXPECT_NE(test::html_problem("<p>a"), "");
    EXPECT_NE(test::html_problem("<p><b>a</p></b>"), "");
    EXPECT_NE(test::html_problem("<img src=\"https://example.org/a.png\">"), "");
    EXPECT_NE(test::html_problem("<style>a{background:url(//example.org/a.png)}</style>"), "");
    EXPECT_NE(test::html_problem("<style>@import 'a.css';</style>"), "");
    EXPECT_NE(test::html_problem("<script>a()</script>"), "");
}

TEST(Page, SaysWhereItCannotBeWritten) {
    EXPECT_THROW(Page("a", "b").write("no/such/folder/a.html"), UserError);
}

} // namespace
} // namespace fieldcast::report
