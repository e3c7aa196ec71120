// SPDX-License-Identifier: Apache-2.0
#include "client/load/metrics_page.h"

#include "core/base/error.h"
#include "tests/fuzz/input.h"

#include <cmath>

namespace fieldcast::fuzz {

void metrics_page(Bytes input) {
    const std::string text(as_text(input));
    const client::load::Metrics metrics = client::load::parse_metrics(text);
    FC_ASSERT(metrics.size() <= 10'000, "no more values than the limit");
    for (const auto& [name, value] : metrics) {
        FC_ASSERT(std::isfinite(value), "values are numbers");
    }
    if (const auto url = client::load::parse_metrics_url(text)) {
        FC_ASSERT(is_loopback(url->address.host) && url->path.starts_with('/'), "metrics come from this machine");
    }
}

} // namespace fieldcast::fuzz
