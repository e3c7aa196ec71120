// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/document.h"

#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

namespace fieldcast::scene {

/// Closed range of values that a property may have.
struct Range {
    double low = 0.0;
    double high = std::numeric_limits<float>::max();
};

/// A property as a float. Throws UserError if it is not finite in single precision or out of `range`.
/// `object` names the property in messages ("material 3 'glass': ior").
float checked_float(const GltfDocument& document, double value, const std::string& object, const Range& range);

/// A list of exactly `out.length()` finite numbers, each within `range`. Throws UserError otherwise.
template <class Vector>
Vector checked_vector(const GltfDocument& document, const std::vector<double>& values, const std::string& object,
                      const Range& range) {
    Vector out;
    if (values.size() != static_cast<std::size_t>(out.length())) {
        document.refuse(object, "needs " + std::to_string(out.length()) + " numbers");
    }
    for (int i = 0; i < out.length(); ++i) {
        out[i] = checked_float(document, values[static_cast<std::size_t>(i)], object, range);
    }
    return out;
}

/// Member of an extension or of extras; `fallback` if absent.
double number_member(const tinygltf::Value& object, const char* key, double fallback);
/// As above, for a list of numbers; empty if absent.
std::vector<double> numbers_member(const tinygltf::Value& object, const char* key);

inline constexpr Range kAnyNumber{-static_cast<double>(std::numeric_limits<float>::max()),
                                  std::numeric_limits<float>::max()};

/// Emitted light in any unit. Sums and products of numbers in this range stay finite.
inline constexpr Range kEmissionRange{0.0, 1e12};
/// Texture coordinates and their transforms. Beyond this range, single precision cannot distinguish texels.
inline constexpr Range kTextureRange{-1e6, 1e6};

} // namespace fieldcast::scene
