// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace fieldcast::command_line {

/// A new token and the line that makes a server know it, each under a comment that says for whom it is. Throws
/// UserError if `name` or `role` is not one.
std::string new_token_text(const std::string& name, const std::string& role);

} // namespace fieldcast::command_line
