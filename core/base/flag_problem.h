// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace fieldcast {

/// What CLI11 says of a value that it cannot take, in words for people: the flag, the problem, what to write. `kind` is the
/// name of its exception, `said` its text; `type_of` tells the type that CLI11 names for a flag ("UINT"). Text of any other
/// kind stays as it is.
std::string flag_problem(const std::string& kind, const std::string& said,
                         const std::function<std::string(const std::string& flag)>& type_of);

} // namespace fieldcast
