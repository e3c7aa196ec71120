// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/vocabulary.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Typed settings: KEY=VALUE of flags and of scenario files.
namespace fieldcast::client::net {

using SettingProblem = std::string; ///< how to write the value; empty: no problem

// Each sets `result` to the number in `text` if it lies between `low` and `high`, both inclusive.
SettingProblem read_number(const std::string& text, double low, double high, double& result);
SettingProblem read_count(const std::string& text, std::uint32_t low, std::uint32_t high, std::uint32_t& result);
SettingProblem read_float(const std::string& text, double low, double high, float& result);
SettingProblem read_rate(const std::string& text, float& result); ///< frames per second; 0: no particular rate

template <class Value> using WordList = std::vector<std::pair<std::string_view, Value>>;

/// Sets `result` to the value of the word `text`.
template <class Value>
SettingProblem read_word(const std::string& text, const WordList<Value>& words, Value& result) {
    std::string known;
    for (const auto& [word, value] : words) {
        if (word == text) {
            result = value;
            return {};
        }
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    return "write one of " + known;
}

/// The same for an enumeration of core/lightfield/vocabulary.h.
template <class Enum> SettingProblem read_word(const std::string& text, Enum& result) {
    const auto value = from_word<Enum>(text);
    result = value.value_or(result);
    return value ? "" : "write " + alternatives<Enum>();
}

/// By the name of each setting: reads its value from text into its owner.
template <class Owner>
using Setters = std::map<std::string, std::function<SettingProblem(const std::string&, Owner&)>>;

/// "a, b, c".
template <class Owner> std::string names_of(const Setters<Owner>& setters) {
    std::string names;
    for (const auto& [name, setter] : setters) {
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

/// Sets the setting `key` of `owner` to `value`.
template <class Owner>
SettingProblem set(const Setters<Owner>& setters, const std::string& key, const std::string& value, Owner& owner) {
    const auto found = setters.find(key);
    return found != setters.end() ? found->second(value, owner) : "no such setting; settings are " + names_of(setters);
}

/// The parts of `text` between separators; an empty text has one empty part.
std::vector<std::string> split(const std::string& text, char separator);

} // namespace fieldcast::client::net
