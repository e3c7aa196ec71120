// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/command_recorder.h"
#include "tests/gpu/add_offset.spv.h"
#include "tests/gpu/count_groups.spv.h"
#include "tests/gpu/gpu_test.h"

#include <algorithm>
#include <thread>

namespace fieldcast::gpu {
namespace {

using RecorderTest = GpuTest;

struct AddPush {
    std::uint64_t values = 0;
    std::uint32_t count = 0;
    std::uint32_t offset = 0;
};

Kernel add_kernel(const Device& device) {
    return {device, {"add_offset", add_offset_spv}, {{}, sizeof(AddPush)}};
}

TEST_F(RecorderTest, BarriersOrderDispatchesFillsAndCopies) {
    const auto add = add_kernel(device());
    const Buffer values(device(), 4000);
    const Buffer copy(device(), 4000, Memory::kReadback);
    CommandRecorder recorder(device());
    recorder.fill(values, 5);
    recorder.barrier();
    for (int pass = 0; pass < 10; ++pass) {
        recorder.dispatch(add, {}, AddPush{values.address(), 1000, 3}, {groups_for(1000, 64)});
        recorder.barrier();
    }
    recorder.copy(values, copy, 4000);
    recorder.submit();
    EXPECT_THAT(read_buffer_as<std::uint32_t>(device(), copy, 1000), testing::Each(35U));
}

TEST_F(RecorderTest, FillAndCopyKeepToTheirRange) {
    const auto values = make_buffer<std::uint32_t>(device(), std::vector<std::uint32_t>(8, 1));
    const Buffer copy(device(), 32);
    CommandRecorder recorder(device());
    recorder.fill(values, 9, 8, 4);
    recorder.fill(copy, 0);
    recorder.barrier();
    recorder.copy(values, copy, 8, 4, 16);
    recorder.submit();
    EXPECT_THAT(read_buffer_as<std::uint32_t>(device(), copy, 8), testing::ElementsAre(0, 0, 0, 0, 1, 9, 0, 0));
}

TEST_F(RecorderTest, UpdatesTakeTheirPlaceInTheRecording) {
    std::vector<std::uint32_t> words(20000, 7); // two updates of Vulkan
    words.back() = 8;
    const Buffer values(device(), 4 * words.size() + 8);
    const Buffer before(device(), 16);
    CommandRecorder recorder(device());
    recorder.fill(values, 1);
    recorder.barrier();
    recorder.copy(values, before, 16);
    recorder.barrier();
    recorder.update(values, std::as_bytes(std::span(words)), 4);
    std::ranges::fill(words, 0U); // the recording has its own copy
    recorder.submit();
    EXPECT_THAT(read_buffer_as<std::uint32_t>(device(), before, 4), testing::Each(1U));
    const auto after = read_buffer_as<std::uint32_t>(device(), values, words.size() + 2);
    EXPECT_EQ(after.front(), 1U);
    EXPECT_THAT(std::span(after).subspan(1, words.size() - 1), testing::Each(7U));
    EXPECT_EQ(after[words.size()], 8U);
    EXPECT_EQ(after.back(), 1U);
}

TEST_F(RecorderTest, RefusesUpdatesPastTheEnd) {
    const Buffer values(device(), 16);
    const std::vector<std::uint32_t> words(4);
    CommandRecorder recorder(device());
    EXPECT_THROW(recorder.update(values, std::as_bytes(std::span(words)), 4), std::logic_error);
    EXPECT_THROW(recorder.update(values, std::as_bytes(std::span(words)).first(3)), std::logic_error);
}

TEST_F(RecorderTest, IndirectDispatchTakesItsSizeFromABuffer) {
    const Kernel kernel(device(), {"count_groups", count_groups_spv}, {{}, 8});
    const auto groups = make_buffer<std::uint32_t>(device(), std::vector<std::uint32_t>{0, 7, 2, 1});
    const auto counter = make_buffer<std::uint32_t>(device(), std::vector<std::uint32_t>(4, 0));
    CommandRecorder recorder(device());
    recorder.dispatch_indirect(kernel, {}, counter.address(), groups, 4);
    recorder.submit();
    // 14 groups, of which seven lie in row 1.
    EXPECT_EQ(read_buffer_as<std::uint32_t>(device(), counter, 1).front(), 714U);
}

TEST_F(RecorderTest, IndirectDispatchSeesCountsOfAnEarlierKernel) {
    const auto add = add_kernel(device());
    const Kernel kernel(device(), {"count_groups", count_groups_spv}, {{}, 8});
    const auto groups = make_buffer<std::uint32_t>(device(), std::vector<std::uint32_t>{0, 0, 0});
    const auto counter = make_buffer<std::uint32_t>(device(), std::vector<std::uint32_t>(4, 0));
    CommandRecorder recorder(device());
    recorder.dispatch(add, {}, AddPush{groups.address(), 3, 1}, {});
    recorder.barrier();
    recorder.dispatch_indirect(kernel, {}, counter.address(), groups);
    recorder.submit();
    EXPECT_EQ(read_buffer_as<std::uint32_t>(device(), counter, 1).front(), 1U);
}

TEST_F(RecorderTest, StagesOfOneNameAreSummed) {
    if (device().info().timestamp_bits == 0) {
        GTEST_SKIP() << "the queue has no timestamps";
    }
    const auto add = add_kernel(device());
    const Buffer values(device(), 4U << 20U);
    const AddPush push{values.address(), 1U << 20U, 1};
    CommandRecorder recorder(device());
    for (const auto* name : {"first", "second", "first"}) {
        recorder.stage(name);
        recorder.dispatch(add, {}, push, {groups_for(push.count, 64)});
        recorder.barrier();
    }
    recorder.submit();
    ASSERT_EQ(recorder.durations().size(), 2U);
    EXPECT_EQ(recorder.durations()[0].stage, "first");
    EXPECT_EQ(recorder.durations()[1].stage, "second");
    for (const auto& duration : recorder.durations()) {
        EXPECT_GT(duration.ms, 0.0);
        EXPECT_LT(duration.ms, 10000.0); // a second per MiB would be a wrong unit
    }
}

TEST_F(RecorderTest, SubmissionWithoutStagesHasNoDurations) {
    CommandRecorder recorder(device());
    recorder.stage("empty");
    recorder.submit();
    EXPECT_EQ(recorder.durations().size(), 1U);
    recorder.submit();
    EXPECT_TRUE(recorder.durations().empty());
}

TEST_F(RecorderTest, TooManyStagesAreOurBug) {
    CommandRecorder recorder(device());
    for (int i = 0; i < 64; ++i) {
        recorder.stage("stage");
    }
    EXPECT_THROW(recorder.stage("one more"), std::logic_error);
    recorder.submit();
}

TEST_F(RecorderTest, RecordersOfSeveralThreadsShareTheQueue) {
    const auto add = add_kernel(device());
    std::vector<Buffer> buffers;
    for (int i = 0; i < 4; ++i) {
        buffers.push_back(make_buffer<std::uint32_t>(device(), std::vector<std::uint32_t>(64, 0)));
    }
    {
        std::vector<std::jthread> threads;
        for (const auto& buffer : buffers) {
            threads.emplace_back([&] {
                CommandRecorder recorder(device());
                for (int i = 0; i < 20; ++i) {
                    recorder.dispatch(add, {}, AddPush{buffer.address(), 64, 1}, {});
                    recorder.submit();
                }
            });
        }
    }
    for (const auto& buffer : buffers) {
        EXPECT_THAT(read_buffer_as<std::uint32_t>(device(), buffer, 64), testing::Each(20U));
    }
}

} // namespace
} // namespace fieldcast::gpu
