// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/markup.h"

#include <cstddef>
#include <vector>

namespace fieldcast::report {

/// A place in a curve chart. The chart says what x and y are.
struct CurvePoint {
    double x = 0.0;
    double y = 0.0;
};

struct Curve {
    std::string label;
    std::vector<CurvePoint> points; ///< in the order of x
    std::size_t series = 0;         ///< 0 … 7, see style.h
};

/// A label below the x axis.
struct Tick {
    double x = 0.0;
    std::string label;
};

/// Curves over a numeric axis, for many points: the y axis begins at 0. Without points there is a note instead.
struct CurveChart {
    std::string title;
    std::string note{};
    std::string unit{};        ///< of y, on the topmost label
    int digits = 0;            ///< of labels of y
    double end_x = 1.0;        ///< the axis covers 0 … end_x
    std::vector<Tick> ticks{}; ///< empty: five, equally spaced, as whole numbers
    std::vector<Curve> curves{};
};
Markup curve_chart(const CurveChart& chart);

} // namespace fieldcast::report
