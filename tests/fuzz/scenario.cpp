// SPDX-License-Identifier: Apache-2.0
#include "client/load/scenario.h"

#include "core/base/error.h"
#include "tests/fuzz/input.h"

#include <cmath>

namespace fieldcast::fuzz {

void scenario(Bytes input) {
    const auto file = scratch_file("scenario.toml", input);
    is_refused([&] {
        const client::load::Scenario scenario = client::load::read_scenario(file);
        FC_ASSERT(!scenario.groups.empty() && client_count(scenario) <= client::load::kMaxClients,
                  "some clients, and no more than the limit");
        FC_ASSERT(std::isfinite(scenario.ramp.count()) && scenario.ramp.count() >= 0, "times are finite");
        FC_ASSERT(std::isfinite(scenario.duration.count()) && scenario.duration.count() >= 0, "times are finite");
    });
}

} // namespace fieldcast::fuzz
