// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/command_recorder.h"
#include "shaders/shared/types.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/scale.spv.h"

#include <bit>

namespace fieldcast::gpu {
namespace {

using KernelTest = GpuTest;

struct ScalePush {
    shared::Vec3Buffer from = 0;
    shared::Vec3Buffer to = 0;
    shared::uint count = 0;
    shared::uint unused = 0;
};

constexpr std::uint32_t kGroupSize = 32;

std::vector<glm::vec3> scaled(const Device& device, std::span<const Specialisation> more,
                              std::span<const glm::vec3> values) {
    std::vector<Specialisation> all = {{0, kGroupSize}};
    all.insert(all.end(), more.begin(), more.end());
    const auto from = make_buffer(device, values);
    const Buffer to(device, values.size_bytes());
    const Kernel kernel(device, {"scale", scale_spv}, {{}, sizeof(ScalePush)}, all);
    const auto count = static_cast<std::uint32_t>(values.size());
    CommandRecorder recorder(device);
    recorder.dispatch(kernel, {}, ScalePush{from.address(), to.address(), count}, {groups_for(count, kGroupSize)});
    recorder.submit();
    return read_buffer_as<glm::vec3>(device, to, values.size());
}

TEST_F(KernelTest, ReachesTightlyPackedVectorsByAddress) {
    std::vector<glm::vec3> values;
    for (int i = 0; i < 100; ++i) {
        values.emplace_back(i, 2 * i, -i);
    }
    EXPECT_EQ(scaled(device(), {}, values), values);
}

TEST_F(KernelTest, TakesSpecialisationConstants) {
    const std::vector<glm::vec3> values = {{1.0F, 2.0F, 3.0F}};
    const std::vector<Specialisation> constants = {{1, std::bit_cast<std::uint32_t>(1.5F)}, {2, 1}};
    EXPECT_THAT(scaled(device(), constants, values), testing::ElementsAre(glm::vec3(-1.5F, -3.0F, -4.5F)));
}

TEST_F(KernelTest, RefusesPushConstantsOfAnotherSize) {
    const std::vector<Specialisation> constants = {{0, kGroupSize}};
    const Kernel kernel(device(), {"scale", scale_spv}, {{}, sizeof(ScalePush)}, constants);
    CommandRecorder recorder(device());
    EXPECT_THROW(recorder.dispatch(kernel, {}, std::uint64_t{0}, {}), std::logic_error);
}

} // namespace
} // namespace fieldcast::gpu
