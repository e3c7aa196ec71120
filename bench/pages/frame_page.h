// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/page.h"

#include <nlohmann/json.hpp>

namespace fieldcast::bench {

/// Kind of work of a stage, with the kinds of the paper's figure 3, such as "path tracing".
std::string kind_of_stage(const std::string& stage);

/// The report of a result of `frame`: its stage times next to those of the paper's figure 3.
report::Page frame_page(const nlohmann::ordered_json& result);

} // namespace fieldcast::bench
