// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/page.h"

#include <nlohmann/json.hpp>

namespace fieldcast::bench {

/// The report of a result of `sources`.
report::Page sources_page(const nlohmann::ordered_json& result);

} // namespace fieldcast::bench
