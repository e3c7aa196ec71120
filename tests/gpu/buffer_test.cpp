// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/command_recorder.h"
#include "tests/gpu/fetch_texels.spv.h"
#include "tests/gpu/gpu_test.h"

#include <numeric>

namespace fieldcast::gpu {
namespace {

using BufferTest = GpuTest;

std::vector<std::uint32_t> counting(std::size_t count) {
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), 1U);
    return values;
}

TEST_F(BufferTest, ReadsWhatWasWrittenInEveryMemory) {
    const auto values = counting(1000);
    for (const auto memory : {Memory::kDevice, Memory::kUpload, Memory::kReadback}) {
        const Buffer buffer(device(), 4000, memory);
        write_buffer(device(), buffer, std::as_bytes(std::span(values)));
        EXPECT_EQ(read_buffer_as<std::uint32_t>(device(), buffer, 1000), values);
    }
}

TEST_F(BufferTest, WritesAndReadsAtOffsets) {
    const auto buffer = make_buffer<std::uint32_t>(device(), counting(8));
    const std::vector<std::uint32_t> two = {70, 80};
    write_buffer(device(), buffer, std::as_bytes(std::span(two)), 8);
    EXPECT_THAT(read_buffer_as<std::uint32_t>(device(), buffer, 4, 4), testing::ElementsAre(2, 70, 80, 5));
}

TEST_F(BufferTest, EmptyBufferHasSixteenBytes) {
    const auto buffer = make_buffer<std::uint32_t>(device(), {});
    EXPECT_EQ(buffer.size_bytes(), 16U);
    EXPECT_NE(buffer.address(), 0U);
    EXPECT_TRUE(read_buffer_as<std::uint32_t>(device(), buffer, 0).empty());
}

TEST_F(BufferTest, RefusesToReadOrWritePastTheEnd) {
    const Buffer buffer(device(), 16);
    std::vector<std::byte> bytes(17);
    EXPECT_THROW(write_buffer(device(), buffer, bytes), std::logic_error);
    EXPECT_THROW(read_buffer(device(), buffer, std::span(bytes).first(16), 1), std::logic_error);
}

TEST_F(BufferTest, LargeTransfersGoInPieces) {
    const auto values = counting((33U << 20U) / 4); // one MiB more than two staging buffers
    const auto buffer = make_buffer<std::uint32_t>(unmapped_device(), values);
    EXPECT_EQ(read_buffer_as<std::uint32_t>(unmapped_device(), buffer, values.size()), values);
}

TEST_F(BufferTest, StagingBuffersAreUsedAgain) {
    const Buffer buffer = make_zero_buffer(unmapped_device(), 4000);
    for (const std::uint32_t count : {10U, 1000U, 1U, 0U, 100U}) {
        const auto values = counting(count);
        write_buffer(unmapped_device(), buffer, std::as_bytes(std::span(values)));
        EXPECT_EQ(read_buffer_as<std::uint32_t>(unmapped_device(), buffer, count), values);
    }
}

TEST_F(BufferTest, MakesRoomOnlyWhereItLacks) {
    Buffer buffer;
    make_room(device(), buffer, 4000);
    const VkBuffer handle = buffer.handle();
    for (const std::uint64_t size_bytes : {4000ULL, 100ULL, 0ULL}) {
        make_room(device(), buffer, size_bytes);
        EXPECT_EQ(buffer.handle(), handle);
        EXPECT_EQ(buffer.size_bytes(), 4000U);
    }
    make_room(device(), buffer, 4001);
    EXPECT_EQ(buffer.size_bytes(), 4001U);
}

TEST_F(BufferTest, DeviceMemoryCanBeLeftUnmapped) {
    EXPECT_EQ(Buffer(unmapped_device(), 64).mapped(), nullptr);
    EXPECT_FALSE(Buffer(unmapped_device(), 64).is_cached());
    EXPECT_NE(Buffer(unmapped_device(), 64, Memory::kUpload).mapped(), nullptr);
    EXPECT_NE(Buffer(unmapped_device(), 64, Memory::kReadback).mapped(), nullptr);
}

TEST_F(BufferTest, IsEmptyAfterMove) {
    Buffer first(device(), 64);
    const Buffer second = std::move(first);
    EXPECT_FALSE(first); // NOLINT(bugprone-use-after-move): that is the promise
    EXPECT_TRUE(second);
}

TEST_F(BufferTest, MemoryOfCpuDevicesIsMapped) {
    if (!device().info().is_cpu) {
        GTEST_SKIP() << "not a CPU device";
    }
    const Buffer buffer(device(), 64);
    EXPECT_NE(buffer.mapped(), nullptr);
    EXPECT_TRUE(buffer.is_cached());
}

TEST_F(BufferTest, FailedAllocationIsAVulkanError) {
    DeviceOptions unvalidated; // the layer would report the size, rightly
    unvalidated.name_contains = device().info().name;
    const Device plain(unvalidated);
    EXPECT_THROW(Buffer(plain, 1ULL << 46U), VulkanError);
}

TEST_F(BufferTest, TexelViewsAreFetched) {
    const auto values = counting(64);
    const auto integers = make_buffer<std::uint32_t>(device(), values);
    const auto floats = make_buffer<float>(device(), std::vector<float>(64, 0.5F));
    const TexelView integer_view(device(), integers, VK_FORMAT_R32G32B32A32_UINT);
    const TexelView float_view(device(), floats, VK_FORMAT_R32G32_SFLOAT);
    const BindingLayout layout(device(), {{0, BindingType::kTexelBuffer}, {1, BindingType::kTexelBuffer}});
    BindingSet set(device(), layout);
    set.set(0, integer_view);
    set.set(1, float_view);
    const Kernel kernel(device(), {"fetch_texels", fetch_texels_spv}, {{&layout}, 8});
    const Buffer sums(device(), 64);

    CommandRecorder recorder(device());
    recorder.dispatch(kernel, {&set}, sums.address(), {});
    recorder.submit();
    // Thread i adds the four integers of texel i and the two floats of texel i.
    const auto results = read_buffer_as<float>(device(), sums, 16);
    for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_EQ(results[i], 16.0F * static_cast<float>(i) + 10.0F + 1.0F);
    }
}

TEST_F(BufferTest, TexelViewOverTheLimitIsAVulkanError) {
    const std::uint64_t elements = std::uint64_t{device().info().max_texel_buffer_elements} + 1;
    if (elements > 1U << 28U) {
        GTEST_SKIP() << "the limit needs too much memory to be exceeded";
    }
    const Buffer buffer(device(), elements);
    EXPECT_THROW(TexelView(device(), buffer, VK_FORMAT_R8_UINT), VulkanError);
}

} // namespace
} // namespace fieldcast::gpu
