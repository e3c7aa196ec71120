// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device_state.h"

namespace fieldcast::gpu {

/// Creates `state.instance`; with `validation` also the validation layer and its messenger, which writes to
/// `state.validation`. Throws UserError without the layer, NoDeviceError without a driver, VulkanError.
void create_instance(DeviceState& state, bool validation);

} // namespace fieldcast::gpu
