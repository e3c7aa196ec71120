// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/metrics/page.h"

namespace fieldcast::metrics {

/// Adds memory, processor time, threads and open files of this process under the names of Prometheus' client libraries.
void add_process_metrics(Page& page);

} // namespace fieldcast::metrics
