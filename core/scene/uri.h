// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fieldcast::scene {

bool is_data_uri(std::string_view uri);

/// Payload of a `data:` URI, base64 or percent-encoded.
Decoded<std::vector<std::byte>> decode_data_uri(std::string_view uri);

/// Checks an untrusted path and returns it without empty and "." segments, '/' separated.
/// Refused: absolute paths, "..", schemes ("file:", "c:"), backslashes, control characters, overlong names.
Decoded<std::string> check_relative_path(std::string_view path);

/// Percent-decodes a relative URI and checks the result as above.
Decoded<std::string> path_of_uri(std::string_view uri);

} // namespace fieldcast::scene
