// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace fieldcast {

/// The variable of the environment that holds a token. There is no flag: other users see a process' arguments.
inline constexpr const char* kTokenVariable = "FIELDCAST_TOKEN";

/// A token: the first line of `file` that is neither empty nor a comment (#), or, without a file, `text`, which may be
/// empty. `flag` names the file's flag in messages. Throws UserError, which never shows the token.
std::string read_bearer_token(const std::filesystem::path& file, const std::string& text, const std::string& flag);

/// The value of FIELDCAST_TOKEN; empty: not set.
std::string token_of_environment();

} // namespace fieldcast
