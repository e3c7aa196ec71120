// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/metrics/instruments.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace fieldcast::metrics {

/// Names and values, in the order in which they are written.
using Labels = std::vector<std::pair<std::string, std::string>>;

/// What a number means.
struct Description {
    std::string name; ///< Prometheus' rules: unit at the end, counters end in _total
    std::string help;
};

/// Numbers at one moment, in the text format that Prometheus scrapes, version 0.0.4
/// (https://prometheus.io/docs/instrumenting/exposition_formats). Series of one name stand together, sorted by name,
/// whatever the order in which they were added.
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
        std::string samples; ///< lines
    };
    Family& family(const Description& what, const char* type);

    std::map<std::string, Family> families_;
};

} // namespace fieldcast::metrics
