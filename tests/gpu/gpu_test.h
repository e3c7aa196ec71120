// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

#include <gmock/gmock.h>

namespace fieldcast::gpu {

/// A test on the best device of this machine, with validation where the layer is installed.
/// Skips without a device; fails if the validation layer reports a message.
class GpuTest : public testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    /// One device for all tests of the binary. Only after SetUp.
    const Device& device() const { return *device_; }

    /// The same device of this machine, opened so that its memory is treated as not host-visible. One for all tests of
    /// the binary. Only after SetUp.
    const Device& unmapped_device() const;

private:
    const Device* device_ = nullptr;
    std::uint32_t messages_before_ = 0; ///< of device()
};

} // namespace fieldcast::gpu
