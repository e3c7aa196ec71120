// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

#include <nlohmann/json.hpp>

namespace fieldcast::bench {

/// The origin of a result: processor, device with driver, commit ("-dirty" if the tree had changes when it was built),
/// command line, UTC time. Every result contains it.
nlohmann::ordered_json provenance(const gpu::Device& device);

/// The same for a benchmark that uses no device.
nlohmann::ordered_json provenance();

} // namespace fieldcast::bench
