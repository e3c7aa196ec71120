// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fieldcast::gpu {

class BindingLayout;

/// A compiled kernel, embedded in the binary.
struct KernelCode {
    const char* name = "";
    std::span<const std::uint32_t> spirv;
};

/// Value of a specialisation constant (bool: 0 or 1; float: its bits through `std::bit_cast`).
struct Specialisation {
    std::uint32_t id = 0;
    std::uint32_t value = 0;
};

/// Descriptor sets and push constants of a pipeline.
struct KernelLayout {
    std::vector<const BindingLayout*> sets; ///< set 0, 1, …
    std::uint32_t push_bytes = 0;           ///< ≤ 128, a multiple of 4
};

} // namespace fieldcast::gpu
