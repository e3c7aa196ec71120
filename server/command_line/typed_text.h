// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <span>
#include <string_view>

namespace fieldcast::command_line {

/// The number that `text` is; empty: it is none, or more than one.
template <class T> std::optional<T> read_number(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// Reads numbers with commas between them, exactly numbers.size() of them. False: `text` is something else.
template <class T> bool read_list(std::string_view text, std::span<T> numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const bool is_last = i + 1 == numbers.size();
        const std::size_t end = is_last ? text.size() : text.find(',');
        const auto number = end == std::string_view::npos ? std::nullopt : read_number<T>(text.substr(0, end));
        if (!number) {
            return false;
        }
        numbers[i] = *number;
        text.remove_prefix(is_last ? end : end + 1);
    }
    return true;
}

} // namespace fieldcast::command_line
