// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace fieldcast::scene {

/// Names the format of a scene file that is not glTF, and what converts it: "this is FBX; …". Looks at the first bytes,
/// and at the extension of `file` for formats whose text begins with anything. Empty: the format is not known.
/// Call it for files that are not glTF.
std::optional<std::string> foreign_format(std::span<const std::byte> bytes, const std::string& file);

} // namespace fieldcast::scene
