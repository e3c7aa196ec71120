// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace fieldcast {

/// Environment variable that holds the token. No flag takes a token, because other users can see the arguments of a
/// process.
inline constexpr const char* kTokenVariable = "FIELDCAST_TOKEN";

/// Returns the first line of `file` that is neither empty nor a comment (#); without a file, returns `text`, which may
/// be empty. Messages call the file by its flag, `flag`. Throws UserError, whose message never shows the token.
std::string read_bearer_token(const std::filesystem::path& file, const std::string& text, const std::string& flag);

/// Value of FIELDCAST_TOKEN; empty if it is not set.
std::string token_of_environment();

} // namespace fieldcast
