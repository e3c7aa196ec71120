// SPDX-License-Identifier: Apache-2.0
#include "client/load/scenario.h"

#include "client/load/metrics_page.h"
#include "core/base/error.h"
#include "core/base/toml_file.h"

#include <set>

namespace fieldcast::client::load {
namespace {

/// Reads the tables of a scenario file and collects problems with file, line and key.
class Reader {
public:
    Reader(std::string file, std::vector<std::string> problems)
        : file_(std::move(file)), problems_(std::move(problems)) {}

    void read(const TomlTable& root, Scenario& scenario) {
        each_entry(root, [&](const auto& key, const auto& value) { return set_in_scenario(key, value, scenario); });
        for (const TomlTable& table : root.children) {
            if (table.name == "target") {
                each_entry(table,
                           [&](const auto& key, const auto& value) { return set_in_target(key, value, scenario); });
                has_no_tables(table);
            } else if (table.name == "thresholds") {
                read_thresholds(table, scenario.thresholds);
            } else if (table.name == "group") {
                read_group(table, scenario);
            } else {
                add(table.line, table.name, "unknown table; expected [target], [[group]] or [thresholds]");
            }
        }
    }

    const std::vector<std::string>& problems() const { return problems_; }

private:
    template <class Set> void each_entry(const TomlTable& table, Set set) {
        for (const TomlEntry& entry : table.entries) {
            const std::string problem =
                entry.values.size() == 1 ? set(entry.key, entry.values.front()) : "write one value";
            if (!problem.empty()) {
                add(entry.line, entry.key, problem);
            }
        }
    }

    void read_group(const TomlTable& table, Scenario& scenario) {
        Group group;
        group.name = "group " + std::to_string(scenario.groups.size() + 1);
        each_entry(table, [&](const auto& key, const auto& value) { return set_in_group(key, value, group); });
        for (const TomlTable& child : table.children) {
            if (child.name == "thresholds") {
                read_thresholds(child, group.thresholds);
            } else {
                add(child.line, child.name, "unknown table; a group may only have thresholds = { … }");
            }
        }
        scenario.groups.push_back(std::move(group));
    }

    void read_thresholds(const TomlTable& table, std::vector<Threshold>& thresholds) {
        each_entry(table, [&](const auto& key, const auto& value) { return add_threshold(key, value, thresholds); });
        has_no_tables(table);
    }

    void has_no_tables(const TomlTable& table) {
        for (const TomlTable& child : table.children) {
            add(child.line, child.name, "tables are not allowed here");
        }
    }

    void add(int line, const std::string& key, const std::string& problem) {
        problems_.push_back(file_ + ":" + std::to_string(line) + ": " + key + ": " + problem);
    }

    std::string file_;
    std::vector<std::string> problems_;
};

void check_target(const Scenario& scenario, std::vector<std::string>& problems) {
    const net::Access& access = scenario.access;
    if (access.tls_certificate.empty() != access.tls_key.empty()) {
        problems.emplace_back("tls-cert and tls-key must be given together");
    }
    const bool has_tls = !access.tls_ca.empty() || !access.tls_key.empty() || !access.tls_name.empty();
    if (has_tls && !access.uses_tls) {
        problems.emplace_back("tls-ca, tls-cert, tls-key and tls-name need tls, or an address with https://");
    }
    if (!scenario.metrics_url.empty()) {
        if (const auto url = parse_metrics_url(scenario.metrics_url); !url) {
            problems.push_back("metrics " + scenario.metrics_url + ": " + url.error());
        }
    }
}

} // namespace

std::vector<std::string> problems_of(const Scenario& scenario) {
    std::vector<std::string> problems;
    check_target(scenario, problems);
    if (scenario.groups.empty()) {
        problems.emplace_back("at least one [[group]] is required");
    }
    if (client_count(scenario) > kMaxClients) {
        problems.push_back("more than " + std::to_string(kMaxClients) + " clients");
    }
    std::set<std::string> names;
    for (const Group& group : scenario.groups) {
        if (group.name.empty() || !names.insert(group.name).second) {
            problems.push_back("group name '" + group.name + "': empty or used twice");
        }
    }
    return problems;
}

Scenario read_scenario(const std::filesystem::path& file) {
    const TomlTree tree = read_toml_tree(file);
    Scenario scenario;
    scenario.name = file.stem().string();
    Reader reader(file.string(), tree.problems);
    reader.read(tree.root, scenario);
    std::vector<std::string> problems = reader.problems();
    if (problems.empty()) {
        scenario.address = net::without_scheme(scenario.address, scenario.access);
        for (const std::string& problem : problems_of(scenario)) {
            problems.push_back(file.string() + ": " + problem);
        }
    }
    std::string text;
    for (const std::string& problem : problems) {
        text += (text.empty() ? "" : "\n") + problem;
    }
    if (!text.empty()) {
        throw UserError(text);
    }
    return scenario;
}

} // namespace fieldcast::client::load
