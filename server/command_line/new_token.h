// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace fieldcast::command_line {

/// A new token and its line for --tokens, each under a comment that names its recipient. Throws
/// UserError if `name` or `role` is not valid.
std::string new_token_text(const std::string& name, const std::string& role);

} // namespace fieldcast::command_line
