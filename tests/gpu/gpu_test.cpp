// SPDX-License-Identifier: Apache-2.0
#include "tests/gpu/gpu_test.h"

#include "core/base/error.h"
#include "core/base/log.h"

#include <variant>

namespace fieldcast::gpu {
namespace {

using DeviceOrReason = std::variant<std::unique_ptr<Device>, std::string>;

std::unique_ptr<Device> open_device() {
    try {
        return std::make_unique<Device>(DeviceOptions{.validation = true});
    } catch (const UserError& error) {
        log::warn("testing without Vulkan validation", {{"reason", error.what()}});
        return std::make_unique<Device>();
    }
}

const DeviceOrReason& shared_device() {
    static const DeviceOrReason kDevice = []() -> DeviceOrReason {
        try {
            return open_device();
        } catch (const NoDeviceError& error) {
            return error.what();
        }
    }();
    return kDevice;
}

} // namespace

void GpuTest::SetUp() {
    if (const auto* reason = std::get_if<std::string>(&shared_device())) {
        GTEST_SKIP() << *reason;
    }
    device_ = std::get<std::unique_ptr<Device>>(shared_device()).get();
    messages_before_ = device_->validation_message_count();
}

void GpuTest::TearDown() {
    if (device_ != nullptr) {
        EXPECT_EQ(device_->validation_message_count(), messages_before_)
            << testing::PrintToString(device_->validation_messages());
    }
}

} // namespace fieldcast::gpu
