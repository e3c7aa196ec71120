// SPDX-License-Identifier: Apache-2.0
#include "tests/gpu/gpu_test.h"

#include "core/base/error.h"
#include "core/base/log.h"

#include <memory>
#include <string>
#include <variant>

namespace fieldcast::gpu {
namespace {

using DeviceOrReason = std::variant<std::unique_ptr<Device>, std::string>;

/// With validation where the layer is installed.
std::unique_ptr<Device> open_device(DeviceOptions options = {}) {
    try {
        options.validation = true;
        return std::make_unique<Device>(options);
    } catch (const UserError& error) {
        log::warn("testing without Vulkan validation", {{"reason", error.what()}});
        options.validation = false;
        return std::make_unique<Device>(options);
    }
}

/// Null before a test asks for it.
std::unique_ptr<Device>& opened_unmapped_device() {
    static std::unique_ptr<Device> device;
    return device;
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
    if (const Device* const device = opened_unmapped_device().get()) {
        EXPECT_EQ(device->validation_message_count(), 0U) << testing::PrintToString(device->validation_messages());
    }
}

const Device& GpuTest::unmapped_device() const {
    std::unique_ptr<Device>& opened = opened_unmapped_device();
    if (opened == nullptr) {
        opened = open_device({.name_contains = device().info().name, .map_device_memory = false});
    }
    return *opened;
}

} // namespace fieldcast::gpu
