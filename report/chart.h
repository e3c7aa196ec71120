// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/markup.h"

#include <optional>
#include <vector>

namespace fieldcast::report {

// Charts are inline SVG. Places along the x axis are percentages, so charts fill any width and their text keeps its
// size. Colours are those of the page's style sheet (style.h), `series` 0 … 7 of them.

/// One bar of a bar chart.
struct Bar {
    std::string label;
    std::optional<double> value; ///< none: no value, which differs from 0
    bool is_highlighted = false; ///< emphasised
};

/// Horizontal bars from 0, labelled with their values. `note` explains the values: "less is better".
struct BarChart {
    std::string title;
    std::string note{};
    int digits = 4;
    std::string unit{};           ///< after each value
    std::optional<double> full{}; ///< value of a bar of full length; none: the largest one
    std::vector<Bar> bars;
};
Markup bar_chart(const BarChart& chart);

/// Part of a whole.
struct Part {
    std::string label;
    double value = 0.0;
    std::size_t series = 0;
};

/// One whole divided into parts, as one bar; parts of 4 % and more are labelled with their share.
struct Stack {
    std::string label;
    std::string total; ///< text at the bar
    std::vector<Part> parts;
};

/// Stacked bars with one legend, in the order of the first stack. Every bar is as long as the page is wide.
Markup stacked_bars(const std::string& title, const std::vector<Stack>& stacks);

/// One line of a line chart; as many values as the chart has points.
struct Line {
    std::string label;
    std::vector<double> values;
    std::size_t series = 0;
};

/// Lines over points with names, for values that lie close to each other: the axis covers their range, not 0.
struct LineChart {
    std::string title;
    std::string note{};
    int digits = 3;
    std::vector<std::string> points;
    std::vector<Line> lines;
};
Markup line_chart(const LineChart& chart);

/// Values of a grid of views, row-major, coloured from `low` to `high`.
struct HeatMap {
    std::string title;
    std::size_t cols = 1;
    std::vector<double> values;
    double low = 0.0;
    double high = 1.0;
    int digits = 3;
};
Markup heat_map(const HeatMap& map);

/// Several heat maps side by side, coloured from the smallest to the largest of all their values.
Markup heat_maps(std::vector<HeatMap> maps);

} // namespace fieldcast::report
