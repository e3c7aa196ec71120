// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"

#include <chrono>
#include <map>
#include <string>
#include <tl/expected.hpp>

namespace fieldcast::client::load {

/// Where a server tells about itself.
struct MetricsUrl {
    HostPort address;
    std::string path; ///< with the leading slash
};

/// http://127.0.0.1:9464/metrics: plain HTTP, so on loopback only. The error says what is wrong.
tl::expected<MetricsUrl, std::string> parse_metrics_url(const std::string& url);

/// Values by name with labels, `fieldcast_frames_sent_total{channel="a"}`.
using Metrics = std::map<std::string, double>;

/// The samples of a page in Prometheus' text format; lines that are none are passed over. At most 10,000 values.
Metrics parse_metrics(const std::string& page);

/// Fetches the page, at most 4 MiB. The error says what went wrong.
tl::expected<Metrics, std::string> fetch_metrics(const MetricsUrl& url, std::chrono::milliseconds patience);

} // namespace fieldcast::client::load
