// SPDX-License-Identifier: Apache-2.0
// Both tables are generated from the headers of shaders/shared, so a new struct is compared without being listed here.
#include "tests/gpu/layout/shared_layout.h"
#include "tests/gpu/layout/shared_layout.spv.h"
#include "tests/gpu/struct_layout.h"

#include <gmock/gmock.h>

namespace fieldcast::gpu {
namespace {

const StructLayout* array_element(const std::vector<StructLayout>& layouts, const std::string& name) {
    for (const auto& layout : layouts) {
        if (layout.name == name && layout.size_bytes != 0) {
            return &layout;
        }
    }
    return nullptr;
}

TEST(SharedLayout, OffsetsAreTheSameInKernelsAndInCpp) {
    const auto layouts = spirv_layouts(shared_layout_spv);
    ASSERT_FALSE(shared::kSharedStructs.empty());
    for (const auto& expected : shared::kSharedStructs) {
        SCOPED_TRACE(expected.name);
        const auto* found = array_element(layouts, expected.name);
        ASSERT_NE(found, nullptr) << "the struct is not in the kernel";
        EXPECT_EQ(found->size_bytes, expected.size_bytes);
        EXPECT_EQ(found->offsets_bytes, expected.offsets_bytes);
    }
}

} // namespace
} // namespace fieldcast::gpu
