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

// Settings that are typed: KEY=VALUE of flags and of scenario files.
namespace fieldcast::client::net {

using SettingProblem = std::string; ///< how to write the value; empty: none

SettingProblem read_number(const std::string& text, double low, double high, double& result);
SettingProblem read_count(const std::string& text, std::uint32_t low, std::uint32_t high, std::uint32_t& result);
SettingProblem read_float(const std::string& text, double low, double high, float& result);
SettingProblem read_rate(const std::string& text, float& result); ///< frames per second; 0: nothing in particular

template <class Value> using WordList = std::vector<std::pair<std::string_view, Value>>;

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

/// Of an enumeration of the stream's vocabulary.
template <class Enum> SettingProblem read_word(const std::string& text, Enum& result) {
    const auto value = from_word<Enum>(text);
    result = value.value_or(result);
    return value ? "" : "write " + alternatives<Enum>();
}

/// What reads a setting's value into its owner.
template <class Owner>
using Setters = std::map<std::string, std::function<SettingProblem(const std::string&, Owner&)>>;

template <class Owner> std::string names_of(const Setters<Owner>& setters) {
    std::string names;
    for (const auto& [name, setter] : setters) {
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

template <class Owner>
SettingProblem set(const Setters<Owner>& setters, const std::string& key, const std::string& value, Owner& owner) {
    const auto found = setters.find(key);
    return found != setters.end() ? found->second(value, owner) : "no such setting; there are " + names_of(setters);
}

/// "a+b+c" at each separator; an empty text has one empty part.
std::vector<std::string> split(const std::string& text, char separator);

} // namespace fieldcast::client::net
