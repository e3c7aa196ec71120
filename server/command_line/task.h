// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fieldcast::command_line {

/// The word in front of the flags; without one, the server serves.
enum class Task : std::uint8_t { kServe, kRender, kRecord, kInspect };

Task task_of(std::string_view word);

/// What is wrong with a word that is no flag and no value of one, and what may have been meant: a task, or a scene.
std::string stray_word_problem(const std::string& word);

} // namespace fieldcast::command_line
