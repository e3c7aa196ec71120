// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"

#include <chrono>
#include <map>
#include <string>
#include <tl/expected.hpp>

namespace fieldcast::client::load {

/// Address of a server's metrics page.
struct MetricsUrl {
    HostPort address;
    std::string path; ///< with the leading slash
};

/// Parses "http://127.0.0.1:9464/metrics". Only loopback is allowed, because HTTP is not encrypted. The error names the
/// problem.
tl::expected<MetricsUrl, std::string> parse_metrics_url(const std::string& url);

/// Values by name with labels, such as `fieldcast_frames_sent_total{channel="a"}`.
using Metrics = std::map<std::string, double>;

/// The samples of a page in Prometheus' text format, at most 10,000. Lines that are not samples are ignored.
Metrics parse_metrics(const std::string& page);

/// Fetches the page, at most 4 MiB. The error names the problem.
tl::expected<Metrics, std::string> fetch_metrics(const MetricsUrl& url, std::chrono::milliseconds patience);

} // namespace fieldcast::client::load
