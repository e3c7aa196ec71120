// SPDX-License-Identifier: Apache-2.0
#include "core/scene/bvh_node.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::scene {

namespace {

constexpr int kMaxExponent = (1 << shared::kBvhExponentBits) - 1;
constexpr int kExponentBias = static_cast<int>(shared::kBvhExponentBias);
constexpr double kCells = 255.0;
/// Slack in cells for the kernel's rounding of `plane · cell + offset`, which is at most 255 cells · 2^-23.
constexpr double kSlackCells = 1e-3;

/// Smallest stored exponent whose 255 cells span `extent` and the slack at both ends.
std::uint32_t exponent_for(double extent) {
    const double cell = extent / (kCells - 2.0 * kSlackCells);
    const int exponent = cell > 0.0 ? static_cast<int>(std::ceil(std::log2(cell))) + kExponentBias : 0;
    return static_cast<std::uint32_t>(std::clamp(exponent, 0, kMaxExponent));
}

double cell_size(std::uint32_t exponent) {
    return std::ldexp(1.0, static_cast<int>(exponent) - kExponentBias);
}

struct AxisPlanes {
    float origin = 0.0F;
    std::uint32_t exponent = 0;
    std::uint32_t low = 0;
    std::uint32_t high = 0;
};

std::uint32_t plane(double cells) {
    return static_cast<std::uint32_t>(std::clamp(cells, 0.0, kCells));
}

AxisPlanes encode_axis(const std::array<NodeChild, shared::kBvhWidth>& children, const Box& all, int axis) {
    AxisPlanes planes;
    if (all.is_empty()) {
        return planes;
    }
    const double lower = all.lower[axis];
    planes.exponent = exponent_for(static_cast<double>(all.upper[axis]) - lower);
    const double cell = cell_size(planes.exponent);
    planes.origin = static_cast<float>(lower - kSlackCells * cell);
    for (std::uint32_t slot = 0; slot < shared::kBvhWidth; ++slot) {
        const NodeChild& child = children[slot];
        // Unused slots get an inverted box. A ray that hits it nevertheless finds no triangles in it.
        std::uint32_t low = 255;
        std::uint32_t high = 0;
        if (child.kind != 0) {
            const double origin = planes.origin;
            low = plane(std::floor((static_cast<double>(child.box.lower[axis]) - origin) / cell - kSlackCells));
            high = plane(std::ceil((static_cast<double>(child.box.upper[axis]) - origin) / cell + kSlackCells));
        }
        planes.low |= low << (8 * slot);
        planes.high |= high << (8 * slot);
    }
    return planes;
}

float decode_plane(float origin, std::uint32_t exponent, std::uint32_t packed, std::uint32_t slot) {
    const double cells = static_cast<double>((packed >> (8 * slot)) & 255U);
    return static_cast<float>(static_cast<double>(origin) + cells * cell_size(exponent));
}

} // namespace

void Box::extend(const glm::vec3& point) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
}

void Box::extend(const Box& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
}

float Box::half_area() const {
    const glm::vec3 size = glm::max(upper - lower, glm::vec3(0.0F));
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

shared::BvhNode encode_node(const std::array<NodeChild, shared::kBvhWidth>& children, std::uint32_t first_child,
                            std::uint32_t first_triangle) {
    Box all;
    std::uint32_t shape = 0;
    for (std::uint32_t slot = 0; slot < shared::kBvhWidth; ++slot) {
        if (children[slot].kind != 0) {
            all.extend(children[slot].box);
        }
        shape |= children[slot].kind << (shared::kBvhKindShift + shared::kBvhKindBits * slot);
    }
    const AxisPlanes x = encode_axis(children, all, 0);
    const AxisPlanes y = encode_axis(children, all, 1);
    const AxisPlanes z = encode_axis(children, all, 2);
    shape |= x.exponent | y.exponent << shared::kBvhExponentBits | z.exponent << (2 * shared::kBvhExponentBits);
    return {{x.origin, y.origin, z.origin},
            shape,
            x.low,
            x.high,
            y.low,
            y.high,
            z.low,
            z.high,
            first_child,
            first_triangle};
}

NodeChild decode_child(const shared::BvhNode& node, std::uint32_t slot) {
    constexpr std::uint32_t kExponentMask = (1U << shared::kBvhExponentBits) - 1U;
    constexpr std::uint32_t kKindMask = (1U << shared::kBvhKindBits) - 1U;
    const std::array<std::uint32_t, 3> low{node.low_x, node.low_y, node.low_z};
    const std::array<std::uint32_t, 3> high{node.high_x, node.high_y, node.high_z};
    NodeChild child;
    child.kind = (node.shape >> (shared::kBvhKindShift + shared::kBvhKindBits * slot)) & kKindMask;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t exponent = (node.shape >> (shared::kBvhExponentBits * axis)) & kExponentMask;
        const auto component = static_cast<glm::vec3::length_type>(axis);
        child.box.lower[component] = decode_plane(node.origin[component], exponent, low[axis], slot);
        child.box.upper[component] = decode_plane(node.origin[component], exponent, high[axis], slot);
    }
    return child;
}

} // namespace fieldcast::scene
