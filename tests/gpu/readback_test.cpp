// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/readback.h"

#include "tests/gpu/gpu_test.h"

#include <numeric>
#include <thread>

namespace fieldcast::gpu {
namespace {

std::vector<std::uint32_t> counting(std::size_t count, std::uint32_t first = 1) {
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

/// `count` words of `buffer` from word `first` on.
ReadbackPart part_of(const Buffer& buffer, std::size_t first, std::span<std::uint32_t> words) {
    return {&buffer, 4 * first, std::as_writable_bytes(words)};
}

/// On a device whose memory is mapped where it can be, and on one that treats its memory as not host-visible.
class ReadbackTest : public GpuTest, public testing::WithParamInterface<bool> {
protected:
    const Device& tested() const { return GetParam() ? device() : unmapped_device(); }
};

INSTANTIATE_TEST_SUITE_P(Memory, ReadbackTest, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Mapped" : "Unmapped"; });

TEST_P(ReadbackTest, ReadsPartsOfSeveralBuffers) {
    const Buffer first = make_buffer<std::uint32_t>(tested(), counting(1000));
    const Buffer second = make_buffer<std::uint32_t>(tested(), counting(1000, 5000));
    Readback readback(tested());
    for (const std::size_t count : {10UL, 500UL, 0UL, 3UL}) { // the staging buffer grows and is then used in part
        std::vector<std::uint32_t> a(count);
        std::vector<std::uint32_t> b(count);
        std::vector<std::uint32_t> c(1);
        readback.read({part_of(second, 7, a), part_of(first, 20, b), part_of(first, 999, c)});
        EXPECT_EQ(a, counting(count, 5007));
        EXPECT_EQ(b, counting(count, 21));
        EXPECT_EQ(c, counting(1, 1000));
    }
}

TEST_P(ReadbackTest, ReadsWhatTheRecordingWrote) {
    const Buffer buffer = make_zero_buffer(tested(), 4000);
    Readback readback(tested());
    CommandRecorder recorder(tested());
    for (const std::uint32_t value : {3U, 4U}) {
        std::vector<std::uint32_t> words(1000);
        recorder.fill(buffer, value);
        recorder.barrier();
        readback.record(recorder, {part_of(buffer, 0, words)});
        recorder.submit();
        readback.finish();
        EXPECT_THAT(words, testing::Each(value));
        readback.forget();
    }
}

TEST_P(ReadbackTest, RefusesToReadPastTheEnd) {
    const Buffer buffer(tested(), 16);
    std::vector<std::uint32_t> words(4);
    Readback readback(tested());
    EXPECT_THROW(readback.read({part_of(buffer, 1, words)}), std::logic_error);
}

TEST_P(ReadbackTest, ThreadsTransferAtTheSameTime) {
    const Device& shared = tested();
    std::vector<std::jthread> threads;
    for (std::uint32_t thread = 0; thread < 4; ++thread) {
        threads.emplace_back([&shared, thread] {
            for (std::uint32_t round = 0; round < 8; ++round) {
                const auto values = counting(1000 + 100 * round, 10000 * thread + round);
                const Buffer buffer = make_buffer<std::uint32_t>(shared, values);
                EXPECT_EQ(read_buffer_as<std::uint32_t>(shared, buffer, values.size()), values);
            }
        });
    }
}

} // namespace
} // namespace fieldcast::gpu
