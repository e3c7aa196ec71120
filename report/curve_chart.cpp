// SPDX-License-Identifier: Apache-2.0
#include "report/curve_chart.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::report {
namespace {

// The plot is a nested drawing, stretched over the card: 1000 × 1000 units between these edges.
constexpr double kTopPx = 14.0;
constexpr double kBottomPx = 176.0;
constexpr double kLeftPercent = 12.0;
constexpr double kWidthPercent = 86.0;
constexpr double kUnits = 1000.0;
constexpr int kGridLines = 4;

/// 1, 2 or 5 times a power of ten, such that `kGridLines` of it reach `value`.
double round_step(double value) {
    const double rough = value / kGridLines;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= rough * (1.0 - 1e-9)) {
            return factor * power;
        }
    }
    return 10.0 * power;
}

double top_of(const CurveChart& chart) {
    double largest = 0.0;
    for (const Curve& curve : chart.curves) {
        for (const CurvePoint& point : curve.points) {
            largest = std::max(largest, point.y);
        }
    }
    return largest > 0.0 ? kGridLines * round_step(largest) : 1.0;
}

std::string drawn_axes(const CurveChart& chart, double top) {
    std::string content;
    for (int i = 0; i <= kGridLines; ++i) {
        const double y_px = kBottomPx - (kBottomPx - kTopPx) * i / kGridLines;
        const std::string y = fixed(y_px, 1);
        content += joined({"<line class=\"grid\" x1=\"", fixed(kLeftPercent, 0), "%\" x2=\"",
                           fixed(kLeftPercent + kWidthPercent, 0), "%\" y1=\"", y, "\" y2=\"", y, "\"/>"});
        const std::string unit = i == kGridLines && !chart.unit.empty() ? " " + chart.unit : "";
        content += joined({"<text x=\"0\" y=\"", fixed(y_px + 4.0, 1), "\">",
                           escaped(fixed(top * i / kGridLines, chart.digits) + unit), "</text>"});
    }
    std::vector<Tick> ticks = chart.ticks;
    for (int i = 0; chart.ticks.empty() && i <= 4; ++i) {
        ticks.push_back({chart.end_x * i / 4.0, fixed(chart.end_x * i / 4.0, 0)});
    }
    for (const Tick& tick : ticks) {
        content += joined({"<text text-anchor=\"middle\" x=\"",
                           fixed(kLeftPercent + kWidthPercent * tick.x / chart.end_x, 2), "%\" y=\"198\">",
                           escaped(tick.label), "</text>"});
    }
    return content;
}

std::string drawn_curve(const CurveChart& chart, const Curve& curve, double top) {
    std::string points;
    for (const CurvePoint& point : curve.points) {
        const double x = kUnits * point.x / chart.end_x;
        points += joined({fixed(x, 1), ",", fixed(kUnits * (1.0 - point.y / top), 1), " "});
    }
    return joined({"<polyline class=\"curve s", std::to_string(curve.series), "\" points=\"", points,
                   "\"><title>", escaped(curve.label), "</title></polyline>"});
}

Markup legend(const CurveChart& chart) {
    Markup items;
    for (const Curve& curve : chart.curves) {
        Markup item{joined({"<i class=\"s", std::to_string(curve.series), "\"></i>"})};
        item += text(curve.label);
        items += element("li", "", item);
    }
    return element("ul", "legend", items);
}

} // namespace

Markup curve_chart(const CurveChart& chart) {
    Markup caption = text(chart.title);
    if (!chart.note.empty()) {
        caption += element("span", "note", text(chart.note));
    }
    Markup content = element("figcaption", "", caption);
    const bool has_points = std::ranges::any_of(chart.curves, [](const Curve& curve) { return !curve.points.empty(); });
    if (!has_points || chart.end_x <= 0.0) {
        content += element("p", "note", text("nothing was measured"));
        return element("figure", "", content);
    }
    const double top = top_of(chart);
    std::string curves;
    for (const Curve& curve : chart.curves) {
        curves += drawn_curve(chart, curve, top);
    }
    content += Markup{joined({"<svg class=\"plot\" width=\"100%\" height=\"206\" role=\"img\" aria-label=\"",
                              escaped(chart.title), "\">", drawn_axes(chart, top), "<svg x=\"", fixed(kLeftPercent, 0),
                              "%\" y=\"", fixed(kTopPx, 0), "\" width=\"", fixed(kWidthPercent, 0), "%\" height=\"",
                              fixed(kBottomPx - kTopPx, 0),
                              "\" viewBox=\"0 0 1000 1000\" preserveAspectRatio=\"none\">", curves, "</svg></svg>\n"})};
    if (chart.curves.size() > 1) {
        content += legend(chart);
    }
    return element("figure", "", content);
}

} // namespace fieldcast::report
