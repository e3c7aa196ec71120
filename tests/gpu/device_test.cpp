// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "tests/gpu/gpu_test.h"

#include <cstdlib>

namespace fieldcast::gpu {
namespace {

using DeviceTest = GpuTest;

TEST_F(DeviceTest, DescribesItself) {
    const auto& info = device().info();
    EXPECT_FALSE(info.name.empty());
    EXPECT_FALSE(info.driver.empty());
    EXPECT_GT(info.uuid_hex.size(), 32U);
    EXPECT_GE(info.max_texel_buffer_elements, 65536U); // the least that Vulkan allows
    EXPECT_GE(info.limits.maxPushConstantsSize, 128U);
}

TEST_F(DeviceTest, ErrorForUnknownNameListsWhatIsThere) {
    try {
        const Device other(DeviceOptions{.name_contains = "no such device"});
        FAIL() << "expected NoDeviceError";
    } catch (const NoDeviceError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(device().info().name));
        EXPECT_THAT(error.what(), testing::HasSubstr("no such device"));
        EXPECT_THAT(error.what(), testing::HasSubstr("mesa-vulkan-drivers"));
    }
}

TEST_F(DeviceTest, IsFoundByItsNameInAnyCase) {
    auto name = device().info().name;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const Device same(DeviceOptions{.name_contains = name});
    EXPECT_EQ(same.info().uuid_hex, device().info().uuid_hex);
}

TEST_F(DeviceTest, RayQueryCanBeRefused) {
    const Device plain(DeviceOptions{.name_contains = device().info().name, .allow_ray_query = false});
    EXPECT_FALSE(plain.info().has_ray_query);
}

TEST_F(DeviceTest, MissingValidationLayerNamesThePackage) {
    setenv("VK_LAYER_PATH", "/nonexistent", 1);
    try {
        const Device validated(DeviceOptions{.validation = true});
        ADD_FAILURE() << "expected UserError";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("vulkan-validationlayers"));
    }
    unsetenv("VK_LAYER_PATH");
}

TEST_F(DeviceTest, ValidationMessagesAreCounted) {
    try {
        const Device validated(DeviceOptions{.validation = true});
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = 16; // and no usage, which is an error
        VkBuffer buffer = VK_NULL_HANDLE;
        vkCreateBuffer(validated.handle(), &info, nullptr, &buffer);
        vkDestroyBuffer(validated.handle(), buffer, nullptr);
        EXPECT_EQ(validated.validation_message_count(), 1U);
        EXPECT_THAT(validated.validation_messages(), testing::ElementsAre(testing::HasSubstr("usage")));
    } catch (const UserError& error) {
        GTEST_SKIP() << error.what();
    }
}

TEST(VulkanResult, FailureNamesTheCall) {
    EXPECT_NO_THROW(check(VK_SUCCESS, "vkCall"));
    EXPECT_NO_THROW(check(VK_INCOMPLETE, "vkCall"));
    try {
        check(VK_ERROR_DEVICE_LOST, "vkQueueSubmit2");
        FAIL() << "expected VulkanError";
    } catch (const VulkanError& error) {
        EXPECT_STREQ(error.what(), "vkQueueSubmit2: device lost");
    }
}

} // namespace
} // namespace fieldcast::gpu
