// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/task.h"

#include "server/command_line/config_file.h"

#include <array>
#include <filesystem>
#include <utility>
#include <vector>

namespace fieldcast::command_line {

namespace {

constexpr std::array kWords{std::pair(std::string_view("render"), Task::kRender),
                            std::pair(std::string_view("record"), Task::kRecord),
                            std::pair(std::string_view("inspect"), Task::kInspect)};

} // namespace

Task task_of(std::string_view word) {
    for (const auto& [known, task] : kWords) {
        if (known == word) {
            return task;
        }
    }
    return Task::kServe;
}

std::string stray_word_problem(const std::string& word) {
    std::vector<std::string> words;
    for (const auto& [known, task] : kWords) {
        words.emplace_back(known);
    }
    std::error_code ignored;
    if (std::filesystem::is_regular_file(word, ignored)) {
        return word + ": belongs to no flag; did you mean --scene " + word + "?";
    }
    const std::string nearest = nearest_word(word, words);
    return word + ": belongs to no flag" + (nearest.empty() ? "" : "; did you mean " + nearest + "?");
}

} // namespace fieldcast::command_line
