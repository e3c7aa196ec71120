// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/config_file.h"

#include "core/base/flag_problem.h"
#include "core/base/toml_file.h"

#include <algorithm>
#include <numeric>

namespace fieldcast::command_line {

namespace {

/// Levenshtein's distance: insertions, deletions and replacements that lead from one word to the other.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1); // distances of a's beginning from each beginning of b
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

/// The flag that a key stands for; null if there is none that a file may set.
const CLI::Option* find_setting(const CLI::App& app, const std::string& key) {
    const CLI::Option* const option = app.get_option_no_throw("--" + key);
    return option != nullptr && option->get_configurable() ? option : nullptr;
}

bool is_switch(const CLI::Option& option) {
    return option.get_expected_max() == 0;
}

/// Adds an entry for which there is a flag, unless the command line has that flag, too.
void add_arguments(const TomlEntry& entry, const CLI::Option& option, const std::string& place, FileArguments& result) {
    const std::string flag = "--" + entry.key;
    if (is_switch(option) != entry.is_switch) {
        result.problems.push_back(place + ": " + entry.key +
                                  (is_switch(option) ? ": write true or false" : ": needs a value"));
        return;
    }
    if (option.count() > 0) {
        return;
    }
    result.places[flag] = place;
    for (const std::string& value : entry.values) {
        if (!value.empty()) { // an empty text means: not set
            result.arguments.push_back(flag + "=" + value);
        }
    }
}

/// What an option has been given, or its default.
std::vector<std::string> values_of(const CLI::Option& option) {
    if (option.count() > 0) {
        return option.results();
    }
    return option.get_default_str().empty() ? std::vector<std::string>{} : std::vector{option.get_default_str()};
}

bool is_number(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    return type == "UINT" || type == "INT" || type == "FLOAT";
}

std::string value_text(const CLI::Option& option, const std::vector<std::string>& values) {
    const auto element = [&](const std::string& value) { return is_number(option) ? value : toml_quoted(value); };
    if (option.get_expected_max() <= 1) {
        return element(values.front());
    }
    std::string text;
    for (const std::string& value : values) {
        text += (text.empty() ? "" : ", ") + element(value);
    }
    return "[" + text + "]";
}

} // namespace

FileArguments read_config_file(const std::filesystem::path& file, const CLI::App& app) {
    const TomlFile toml = read_toml(file);
    FileArguments result{.arguments = {}, .places = {}, .problems = toml.problems, .is_parsed = toml.is_parsed};
    for (const TomlEntry& entry : toml.entries) {
        const std::string place = file.string() + ":" + std::to_string(entry.line);
        if (const CLI::Option* const option = find_setting(app, entry.key)) {
            add_arguments(entry, *option, place, result);
        } else {
            const std::string nearest = nearest_flag("--" + entry.key, app);
            result.problems.push_back(place + ": " + entry.key + ": there is no such setting" +
                                      (nearest.empty() ? "" : "; did you mean " + nearest.substr(2) + "?"));
        }
    }
    return result;
}

std::string problem_text(const CLI::ParseError& error, const CLI::App& app) {
    return flag_problem(error.get_name(), error.what(), [&](const std::string& flag) {
        const CLI::Option* const option = app.get_option_no_throw(flag);
        return option == nullptr ? std::string() : option->get_type_name();
    });
}

std::string flag_name(const std::string& argument) {
    return argument.substr(0, argument.find_first_of("= :"));
}

std::string with_place(const std::string& problem, const Places& places) {
    const std::string flag = flag_name(problem);
    const auto place = places.find(flag);
    return place == places.end() ? problem : place->second + ": " + problem.substr(2);
}

std::string nearest_flag(const std::string& name, const CLI::App& app) {
    std::vector<std::string> flags;
    for (const CLI::Option* const option : app.get_options()) {
        if (option->get_configurable()) {
            flags.push_back(option->get_name());
        }
    }
    return nearest_word(name, flags);
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
    constexpr std::size_t kLettersPerMistake = 3;
    const std::size_t letters = word.size() - (word.starts_with("--") ? 2 : 0);
    std::string best;
    std::size_t best_distance = letters / kLettersPerMistake + 1;
    for (const std::string& candidate : words) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance + (best.empty() ? 1 : 0)) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

std::string config_text(const CLI::App& app) {
    std::string text;
    std::string group;
    for (const CLI::Option* const option : app.get_options()) {
        if (!option->get_configurable()) {
            continue;
        }
        const std::vector<std::string> values = values_of(*option);
        if (!is_switch(*option) && values.empty()) {
            continue;
        }
        if (option->get_group() != group) {
            group = option->get_group();
            text += (text.empty() ? "# " : "\n# ") + group + "\n";
        }
        const bool is_on = is_switch(*option) && option->count() > 0 && option->as<bool>();
        text += option->get_name().substr(2) + " = ";
        text += is_switch(*option) ? (is_on ? "true" : "false") : value_text(*option, values);
        text += "\n";
    }
    return text;
}

} // namespace fieldcast::command_line
