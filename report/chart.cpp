// SPDX-License-Identifier: Apache-2.0
#include "report/chart.h"

#include "core/base/error.h"
#include "report/page.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fieldcast::report {

namespace {

constexpr double kLabelledShare = 0.04; // of a stacked bar; smaller parts have no room for a number
constexpr double kRoomyShare = 0.12;    // smaller parts have no room on a phone

std::string percent(double share) {
    return fixed(100.0 * share, 2) + "%";
}

Markup heading(const std::string& title, const std::string& note) {
    Markup content = text(title);
    if (!note.empty()) {
        content += element("span", "note", text(note));
    }
    return element("figcaption", "", content);
}

Markup svg(std::string_view style, int height_px, const std::string& label, const std::string& content) {
    return {joined({"<svg class=\"", style, "\" width=\"100%\" height=\"", std::to_string(height_px),
                    "\" role=\"img\" aria-label=\"", escaped(label), "\">", content, "</svg>\n"})};
}

std::string tooltip(const std::string& content) {
    return joined({"<title>", escaped(content), "</title>"});
}

Markup bar(const BarChart& chart, const Bar& bar, double longest) {
    const std::string value = bar.value ? fixed(*bar.value, chart.digits) + chart.unit : "–";
    const double share = bar.value && longest > 0.0 ? std::max(0.0, *bar.value / longest) : 0.0;
    const std::string style = bar.is_highlighted ? "bar ours" : "bar";
    Markup row = element("span", "label", text(bar.label));
    row += svg("line", 16, bar.label + ": " + value,
               joined({"<rect class=\"", style, "\" x=\"0\" y=\"2\" width=\"", percent(share),
                       "\" height=\"12\" rx=\"2\">", tooltip(bar.label + ": " + value), "</rect>"}));
    row += element("span", bar.is_highlighted ? "value strong" : "value", text(value));
    return element("div", "row", row);
}

std::string stack_rects(const Stack& stack, double total) {
    std::string content;
    double begin = 0.0;
    for (const Part& part : stack.parts) {
        const double share = part.value / total;
        content +=
            joined({"<rect class=\"s", std::to_string(part.series), "\" x=\"", percent(begin), "\" y=\"0\" width=\"",
                    percent(share), "\" height=\"34\">", tooltip(part.label + ": " + percent(share)), "</rect>"});
        if (share >= kLabelledShare) {
            const char* style = share < kRoomyShare ? "inside narrow" : "inside";
            content += joined({"<text class=\"", style, "\" x=\"", percent(begin + share / 2.0),
                               "\" y=\"22\" text-anchor=\"middle\">", fixed(100.0 * share, 0), " %</text>"});
        }
        begin += share;
    }
    return content;
}

Markup legend(const std::vector<std::pair<std::string, std::size_t>>& entries) {
    Markup items;
    for (const auto& [label, series] : entries) {
        Markup item{joined({"<i class=\"s", std::to_string(series), "\"></i>"})};
        item += text(label);
        items += element("li", "", item);
    }
    return element("ul", "legend", items);
}

/// Values of an axis, and where they lie.
struct Axis {
    double low;
    double high;
    int top_px = 14;
    int bottom_px = 176;

    double y(double value) const { return bottom_px - (value - low) / (high - low) * (bottom_px - top_px); }
};

Axis axis_of(const LineChart& chart) {
    double low = chart.lines.at(0).values.at(0);
    double high = low;
    for (const Line& line : chart.lines) {
        FC_ASSERT(line.values.size() == chart.points.size(), "a line has a value for each point");
        low = std::min(low, *std::ranges::min_element(line.values));
        high = std::max(high, *std::ranges::max_element(line.values));
    }
    const double margin = std::max(0.15 * (high - low), 0.5 * std::pow(10.0, -chart.digits));
    return {low - margin, high + margin};
}

double point_x(const LineChart& chart, std::size_t index) {
    constexpr double kFirst = 0.16;
    constexpr double kLast = 0.92;
    return chart.points.size() < 2
               ? 0.5
               : kFirst + (kLast - kFirst) * static_cast<double>(index) / static_cast<double>(chart.points.size() - 1);
}

std::string draw_axis(const LineChart& chart, const Axis& axis) {
    std::string content;
    for (int i = 0; i <= 4; ++i) {
        const double value = axis.low + (axis.high - axis.low) * i / 4.0;
        const std::string y = fixed(axis.y(value), 1);
        content += joined({"<line class=\"grid\" x1=\"12%\" x2=\"96%\" y1=\"", y, "\" y2=\"", y, "\"/>"});
        content +=
            joined({"<text x=\"0\" y=\"", fixed(axis.y(value) + 4.0, 1), "\">", fixed(value, chart.digits), "</text>"});
    }
    for (std::size_t i = 0; i < chart.points.size(); ++i) {
        content += joined({"<text text-anchor=\"middle\" x=\"", percent(point_x(chart, i)), "\" y=\"198\">",
                           escaped(chart.points[i]), "</text>"});
    }
    return content;
}

std::string draw_line(const LineChart& chart, const Line& line, const Axis& axis) {
    std::string content;
    const std::string style = joined({"s", std::to_string(line.series)});
    for (std::size_t i = 0; i < line.values.size(); ++i) {
        const std::string x = percent(point_x(chart, i));
        const std::string y = fixed(axis.y(line.values[i]), 1);
        if (i > 0) {
            content += joined({"<line class=\"stroke ", style, "\" x1=\"", percent(point_x(chart, i - 1)), "\" y1=\"",
                               fixed(axis.y(line.values[i - 1]), 1), "\" x2=\"", x, "\" y2=\"", y, "\"/>"});
        }
        const std::string hint =
            joined({line.label, ", ", chart.points[i], ": ", fixed(line.values[i], chart.digits + 1)});
        content += joined(
            {"<circle class=\"", style, "\" cx=\"", x, "\" cy=\"", y, "\" r=\"4\">", tooltip(hint), "</circle>"});
    }
    return content;
}

} // namespace

Markup bar_chart(const BarChart& chart) {
    double longest = chart.full.value_or(0.0);
    for (const Bar& candidate : chart.bars) {
        longest = std::max(longest, candidate.value.value_or(0.0));
    }
    Markup content = heading(chart.title, chart.note);
    for (const Bar& each : chart.bars) {
        content += bar(chart, each, longest);
    }
    return element("figure", "bars", content);
}

Markup stacked_bars(const std::string& title, const std::vector<Stack>& stacks) {
    Markup content = heading(title, {});
    std::vector<std::pair<std::string, std::size_t>> entries;
    for (const Stack& stack : stacks) {
        double total = 0.0;
        for (const Part& part : stack.parts) {
            total += part.value;
            const std::pair entry{part.label, part.series};
            if (std::ranges::find(entries, entry) == entries.end()) {
                entries.push_back(entry);
            }
        }
        Markup label = element("span", "", text(stack.label));
        label += element("span", "value", text(stack.total));
        content += element("div", "stack-label", label);
        content += svg("stack", 34, stack.label + ", " + stack.total, stack_rects(stack, std::max(total, 1e-9)));
    }
    content += legend(entries);
    return element("figure", "", content);
}

Markup line_chart(const LineChart& chart) {
    const Axis axis = axis_of(chart);
    std::string drawing = draw_axis(chart, axis);
    std::vector<std::pair<std::string, std::size_t>> entries;
    for (const Line& line : chart.lines) {
        drawing += draw_line(chart, line, axis);
        entries.emplace_back(line.label, line.series);
    }
    Markup content = heading(chart.title, chart.note);
    content += svg("plot", 206, chart.title, drawing);
    if (entries.size() > 1) {
        content += legend(entries);
    }
    return element("figure", "", content);
}

Markup heat_map(const HeatMap& map) {
    Markup rows;
    for (std::size_t i = 0; i < map.values.size(); i += map.cols) {
        std::string cells;
        for (std::size_t k = i; k < std::min(i + map.cols, map.values.size()); ++k) {
            const double range = std::max(map.high - map.low, 1e-12);
            const double share = std::clamp((map.values[k] - map.low) / range, 0.0, 1.0);
            cells += joined(
                {"<td style=\"--heat:", fixed(100.0 * share, 0), "%\">", fixed(map.values[k], map.digits), "</td>"});
        }
        rows += element("tr", "", {cells});
    }
    Markup content = heading(map.title, {});
    content += element("table", "heat", rows);
    return element("figure", "", content);
}

Markup heat_maps(std::vector<HeatMap> maps) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const HeatMap& map : maps) {
        for (const double value : map.values) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    std::vector<Markup> figures;
    for (HeatMap& map : maps) {
        map.low = low;
        map.high = high;
        figures.push_back(heat_map(map));
    }
    return side_by_side(figures);
}

} // namespace fieldcast::report
