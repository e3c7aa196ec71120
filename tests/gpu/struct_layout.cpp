// SPDX-License-Identifier: Apache-2.0
#include "tests/gpu/struct_layout.h"

#include <cstdint>

namespace fieldcast::gpu {
namespace {

// Numbers from the SPIR-V specification 1.6, sections 3.20 and 3.42.
constexpr std::uint32_t kOpName = 5;
constexpr std::uint32_t kOpMemberName = 6;
constexpr std::uint32_t kOpTypeRuntimeArray = 29;
constexpr std::uint32_t kOpDecorate = 71;
constexpr std::uint32_t kOpMemberDecorate = 72;
constexpr std::uint32_t kDecorationArrayStride = 6;
constexpr std::uint32_t kDecorationOffset = 35;
constexpr std::size_t kHeaderWords = 5;

/// What the module says about its ids.
struct Module {
    std::map<std::uint32_t, std::string> names;
    std::map<std::uint32_t, std::map<std::uint32_t, std::string>> member_names;
    std::map<std::uint32_t, std::map<std::uint32_t, std::size_t>> member_offsets;
    std::map<std::uint32_t, std::size_t> strides;           ///< of array types
    std::map<std::uint32_t, std::uint32_t> array_of_struct; ///< struct → runtime array
};

std::string text_at(std::span<const std::uint32_t> words) {
    std::string text;
    for (const auto word : words) {
        for (std::uint32_t shift = 0; shift < 32; shift += 8) {
            const auto c = static_cast<char>((word >> shift) & 0xFFU);
            if (c == '\0') {
                return text;
            }
            text += c;
        }
    }
    return text;
}

void read_instruction(Module& module, std::uint32_t opcode, std::span<const std::uint32_t> operands) {
    switch (opcode) {
    case kOpName:
        module.names[operands[0]] = text_at(operands.subspan(1));
        break;
    case kOpMemberName:
        module.member_names[operands[0]][operands[1]] = text_at(operands.subspan(2));
        break;
    case kOpTypeRuntimeArray:
        module.array_of_struct[operands[1]] = operands[0];
        break;
    case kOpDecorate:
        if (operands[1] == kDecorationArrayStride) {
            module.strides[operands[0]] = operands[2];
        }
        break;
    case kOpMemberDecorate:
        if (operands[2] == kDecorationOffset) {
            module.member_offsets[operands[0]][operands[1]] = operands[3];
        }
        break;
    default:
        break;
    }
}

} // namespace

std::vector<StructLayout> spirv_layouts(std::span<const std::uint32_t> words) {
    Module module;
    for (std::size_t at = kHeaderWords; at < words.size();) {
        const std::size_t length = words[at] >> 16U;
        read_instruction(module, words[at] & 0xFFFFU, words.subspan(at + 1, length - 1));
        at += length;
    }
    std::vector<StructLayout> layouts;
    for (const auto& [id, offsets] : module.member_offsets) {
        StructLayout layout;
        layout.name = module.names[id];
        if (const auto array = module.array_of_struct.find(id); array != module.array_of_struct.end()) {
            layout.size_bytes = module.strides[array->second];
        }
        for (const auto& [member, offset] : offsets) {
            layout.offsets_bytes[module.member_names[id][member]] = offset;
        }
        layouts.push_back(layout);
    }
    return layouts;
}

} // namespace fieldcast::gpu
