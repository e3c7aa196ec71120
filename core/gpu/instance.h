// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device_state.h"

namespace fieldcast::gpu {

/// Creates `state.instance`, with the validation layer and its messenger if asked for.
void create_instance(Device::State& state, bool validation);

} // namespace fieldcast::gpu
