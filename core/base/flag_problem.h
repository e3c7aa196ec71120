// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace fieldcast {

/// Rewrites CLI11's message about a value that it rejects: the result names the flag, the problem and a valid value.
/// `kind` is the name of CLI11's exception, `said` is its text. `type_of` returns the type that CLI11 names for a flag
/// ("UINT"). Returns text of any other kind unchanged.
std::string flag_problem(const std::string& kind, const std::string& said,
                         const std::function<std::string(const std::string& flag)>& type_of);

} // namespace fieldcast
