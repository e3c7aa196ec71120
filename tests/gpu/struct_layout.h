// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::gpu {

/// Where the members of a struct lie, in bytes.
struct StructLayout {
    std::string name;
    std::size_t size_bytes = 0; ///< distance of array elements
    std::map<std::string, std::size_t> offsets_bytes;
};

/// Layouts of all structs of a SPIR-V module that have member offsets. A struct may occur several times.
std::vector<StructLayout> spirv_layouts(std::span<const std::uint32_t> words);

} // namespace fieldcast::gpu
