// SPDX-License-Identifier: Apache-2.0
#include "report/curve_chart.h"

#include "tests/unit/report/html_check.h"

#include <gmock/gmock.h>

namespace fieldcast::report {
namespace {

using testing::HasSubstr;
using testing::Not;

CurveChart chart_to(double largest) {
    return {.title = "rate",
            .unit = "ms",
            .end_x = 10.0,
            .curves = {{"a", {{0.0, 0.0}, {5.0, largest}, {10.0, 0.0}}, 2}}};
}

TEST(CurveChart, DrawsPointsInItsUnits) {
    const std::string html = curve_chart(chart_to(40.0)).html;
    EXPECT_EQ(test::html_problem(html), "");
    EXPECT_THAT(html, HasSubstr("points=\"0.0,1000.0 500.0,0.0 1000.0,1000.0 \"")); // y of 40 is the upper edge
    EXPECT_THAT(html, HasSubstr("class=\"curve s2\""));
    EXPECT_THAT(html, HasSubstr(">40 ms<"));
    EXPECT_THAT(html, HasSubstr(">10<")); // both a quarter of 40 and the end of x
}

TEST(CurveChart, TheAxisEndsAtARoundNumber) {
    EXPECT_THAT(curve_chart(chart_to(41.0)).html, HasSubstr(">80 ms<"));
    EXPECT_THAT(curve_chart(chart_to(70.0)).html, HasSubstr(">80 ms<"));
    EXPECT_THAT(curve_chart(chart_to(81.0)).html, HasSubstr(">200 ms<"));
    EXPECT_THAT(curve_chart(chart_to(3e6)).html, HasSubstr(">4000000 ms<"));
    EXPECT_THAT(curve_chart(chart_to(0.0)).html, HasSubstr(">1 ms<"));
}

TEST(CurveChart, NamesCurvesAndTicks) {
    CurveChart chart = chart_to(1.0);
    chart.ticks = {{2.5, "<b>"}};
    chart.curves.push_back({"b", {{1.0, 0.5}}, 3});
    const std::string html = curve_chart(chart).html;
    EXPECT_THAT(html, HasSubstr("&lt;b&gt;"));
    EXPECT_THAT(html, HasSubstr("x=\"33.50%\"")); // 12 % + a quarter of 86 %
    EXPECT_THAT(html, HasSubstr("<ul class=\"legend\">"));
    EXPECT_THAT(curve_chart(chart_to(1.0)).html, Not(HasSubstr("legend")));
}

TEST(CurveChart, SaysWhenThereIsNothing) {
    CurveChart chart = chart_to(1.0);
    chart.curves[0].points.clear();
    EXPECT_THAT(curve_chart(chart).html, HasSubstr("nothing was measured"));
    chart = chart_to(1.0);
    chart.end_x = 0.0;
    EXPECT_EQ(test::html_problem(curve_chart(chart).html), "");
    EXPECT_THAT(curve_chart(chart).html, HasSubstr("nothing was measured"));
}

} // namespace
} // namespace fieldcast::report
