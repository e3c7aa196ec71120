// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/vocabulary.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fieldcast::command_line {

/// A word on the command line and the value that it stands for.
template <class T> struct Word {
    std::string_view word;
    T value;
};

inline constexpr std::array kOnOff{Word{.word = "off", .value = false}, Word{.word = "on", .value = true}};

/// Flags that take one of several words. The default of a flag is the word for the value that its variable has when
/// the flag is added, so presets only set variables.
class WordFlags {
public:
    explicit WordFlags(CLI::App& app) : app_(app) {}

    /// `value` and `words` must outlive this.
    template <class T, std::size_t kCount>
    CLI::Option* add(const char* flag, T& value, const std::array<Word<T>, kCount>& words, const char* help) {
        const std::string_view now = std::ranges::find(words, value, &Word<T>::value)->word;
        return add(flag, now, help, [&value, &words, flag](const std::string& text, Problems& problems) {
            const auto found = std::ranges::find(words, text, &Word<T>::word);
            if (found != words.end()) {
                value = found->value;
                return;
            }
            std::string allowed;
            for (const Word<T>& word : words) {
                allowed.append(allowed.empty() ? "" : ", ").append(word.word);
            }
            problems.push_back(std::string(flag) + " " + text + ": one of " + allowed);
        });
    }

    /// Of an enumeration in the vocabulary of streams.
    template <class Enum> CLI::Option* add(const char* flag, Enum& value, const char* help) {
        return add(flag, word_of(value), help, [&value, flag](const std::string& text, Problems& problems) {
            if (const auto read = from_word<Enum>(text)) {
                value = *read;
            } else {
                problems.push_back(std::string(flag) + " " + text + ": one of " + alternatives<Enum>());
            }
        });
    }

    /// Sets every variable from what was typed; adds a line to `problems` for each word that is not known.
    void read(std::vector<std::string>& problems) const {
        for (const Entry& entry : entries_) {
            entry.read(entry.text, problems);
        }
    }

private:
    using Problems = std::vector<std::string>;
    using Read = std::function<void(const std::string& text, Problems& problems)>;
    struct Entry {
        std::string text;
        Read read;
    };

    CLI::Option* add(const char* flag, std::string_view default_word, const char* help, Read read) {
        entries_.push_back({.text = std::string(default_word), .read = std::move(read)});
        return app_.add_option(flag, entries_.back().text, help)->capture_default_str();
    }

    CLI::App& app_;
    std::deque<Entry> entries_; ///< at fixed addresses: options write to `text`
};

} // namespace fieldcast::command_line
