// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/metrics/page.h"

namespace fieldcast::metrics {

/// Memory, processor time, threads and open files of this process, under the names that Prometheus' own clients use.
void add_process_metrics(Page& page);

} // namespace fieldcast::metrics
