// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/metrics/instruments.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace fieldcast::metrics {

/// Names and values of labels, in the order of output.
using Labels = std::vector<std::pair<std::string, std::string>>;

/// Name and help text of a metric.
struct Description {
    std::string name; ///< follows Prometheus' rules: unit at the end, counters end in _total
    std::string help;
};

/// Values at one moment in Prometheus' text format, version 0.0.4
/// (https://prometheus.io/docs/instrumenting/exposition_formats). Metrics are sorted by name, independent of the order
/// in which they were added; all series of a metric are adjacent.
class Page {
public:
    void add_counter(const Description& what, const Labels& labels, double value);
    void add_gauge(const Description& what, const Labels& labels, double value);
    void add_histogram(const Description& what, const Labels& labels, const Histogram& histogram);

    std::string text() const;

private:
    struct Family {
        std::string help;
        std::string type;
        std::string samples; ///< lines of text
    };
    Family& family(const Description& what, const char* type);

    std::map<std::string, Family> families_;
};

} // namespace fieldcast::metrics
