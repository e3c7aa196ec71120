// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/page.h"

#include <nlohmann/json.hpp>

namespace fieldcast::bench {

/// Kind of work that a stage of a frame belongs to, as the paper's figure 3 tells them apart: "path tracing".
std::string kind_of_stage(const std::string& stage);

/// The report of a result of `frame`: where the time goes, beside the paper's figure 3.
report::Page frame_page(const nlohmann::ordered_json& result);

} // namespace fieldcast::bench
