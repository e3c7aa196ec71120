// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/numbers.h"

namespace fieldcast::scene {

float checked_float(const GltfDocument& document, double value, const std::string& object, const Range& range) {
    if (!(value >= range.low && value <= range.high)) { // false for NaN
        document.refuse(object, std::to_string(value) + " is not between " + std::to_string(range.low) + " and " +
                                    std::to_string(range.high));
    }
    return static_cast<float>(value);
}

double number_member(const tinygltf::Value& object, const char* key, double fallback) {
    return object.Has(key) && object.Get(key).IsNumber() ? object.Get(key).GetNumberAsDouble() : fallback;
}

std::vector<double> numbers_member(const tinygltf::Value& object, const char* key) {
    std::vector<double> numbers;
    const tinygltf::Value& list = object.Has(key) ? object.Get(key) : tinygltf::Value();
    for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
        numbers.push_back(list.Get(static_cast<int>(i)).GetNumberAsDouble());
    }
    return numbers;
}

} // namespace fieldcast::scene
