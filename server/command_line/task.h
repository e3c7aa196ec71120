// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fieldcast::command_line {

/// Selected by the word in front of the flags; without a word, the server serves.
enum class Task : std::uint8_t { kServe, kRender, kRecord, kInspect };

Task task_of(std::string_view word);

/// The problem of a word that is neither a flag nor a value, with a suggestion: a task, or a scene.
std::string stray_word_problem(const std::string& word);

} // namespace fieldcast::command_line
