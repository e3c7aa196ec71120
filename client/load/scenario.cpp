// SPDX-License-Identifier: Apache-2.0
#include "client/load/scenario.h"

#include "client/net/request_text.h"

namespace fieldcast::client::load {
namespace {

constexpr double kMaxSeconds = 1e7;

using Problem = net::SettingProblem;
using net::read_count;
using net::read_number;
using net::read_word;
using net::Setters;

Problem read_seconds(const std::string& text, Seconds& result) {
    double number = 0.0;
    Problem problem = read_number(text, 0.0, kMaxSeconds, number);
    result = Seconds(number);
    return problem;
}

/// A setter that stores the text unchanged.
template <class Owner> auto text_in(std::string Owner::*member) {
    return [member](const std::string& text, Owner& owner) {
        owner.*member = text;
        return Problem();
    };
}

/// A setter that stores the text as the name of a file.
auto file_in(std::filesystem::path net::Access::*member) {
    return [member](const std::string& text, Scenario& scenario) {
        scenario.access.*member = text;
        return Problem();
    };
}

/// `own` and the setters of a client's request.
Setters<Group> with_request(Setters<Group> own) {
    for (const auto& [name, setter] : net::request_setters()) {
        own.emplace(name, [set = setter](const std::string& text, Group& group) { return set(text, group.request); });
    }
    return own;
}

const Setters<Group>& group_setters() {
    using Text = const std::string&;
    using wire::Decoding;
    static const net::WordList<Decoding> decodings{
        {"full", Decoding::kFull}, {"checksum", Decoding::kChecksum}, {"headers", Decoding::kHeaders}};
    static const net::WordList<bool> leavings{{"politely", false}, {"abruptly", true}};
    static const Setters<Group> own{
        {"name", text_in(&Group::name)},
        {"count", [](Text text, Group& group) { return read_count(text, 1, kMaxClients, group.count); }},
        {"due-fps",
         [](Text text, Group& group) {
             float rate = 0.0F;
             Problem problem = net::read_rate(text, rate);
             group.due_fps = rate;
             return problem;
         }},
        {"decoding", [](Text text, Group& group) { return read_word(text, decodings, group.decoding); }},
        {"reads-kbit-per-second",
         [](Text text, Group& group) {
             Problem problem = read_number(text, 1.0, 1e9, group.max_bytes_per_second);
             group.max_bytes_per_second *= 1000.0 / 8.0;
             return problem;
         }},
        {"think", [](Text text, Group& group) { return read_seconds(text, group.think); }},
        {"stay", [](Text text, Group& group) { return read_seconds(text, group.stay); }},
        {"away", [](Text text, Group& group) { return read_seconds(text, group.away); }},
        {"leaves", [](Text text, Group& group) { return read_word(text, leavings, group.leaves_abruptly); }},
    };
    static const Setters<Group> setters = with_request(own);
    return setters;
}

const Setters<Scenario>& scenario_setters() {
    using Text = const std::string&;
    static const Setters<Scenario> setters{
        {"name", text_in(&Scenario::name)},
        {"ramp", [](Text text, Scenario& all) { return read_seconds(text, all.ramp); }},
        {"duration", [](Text text, Scenario& all) { return read_seconds(text, all.duration); }},
        {"seed", [](Text text, Scenario& all) { return read_count(text, 0, UINT32_MAX, all.seed); }},
        {"threads", [](Text text, Scenario& all) { return read_count(text, 0, 256, all.threads); }},
        {"metrics", text_in(&Scenario::metrics_url)},
    };
    return setters;
}

const Setters<Scenario>& target_setters() {
    using Text = const std::string&;
    static const net::WordList<bool> switches{{"true", true}, {"false", false}};
    static const Setters<Scenario> setters{
        {"address", text_in(&Scenario::address)},
        {"tls", [](Text text, Scenario& all) { return read_word(text, switches, all.access.uses_tls); }},
        {"tls-ca", file_in(&net::Access::tls_ca)},
        {"tls-cert", file_in(&net::Access::tls_certificate)},
        {"tls-key", file_in(&net::Access::tls_key)},
        {"tls-name",
         [](Text text, Scenario& all) {
             all.access.tls_name = text;
             return Problem();
         }},
        {"token-file", file_in(&net::Access::token_file)},
    };
    return setters;
}

} // namespace

std::uint32_t client_count(const Scenario& scenario) {
    std::uint32_t count = 0;
    for (const Group& group : scenario.groups) {
        count += group.count;
    }
    return count;
}

std::string_view name_of(wire::Decoding decoding) {
    switch (decoding) {
    case wire::Decoding::kFull:
        return "full";
    case wire::Decoding::kChecksum:
        return "checksum";
    case wire::Decoding::kHeaders:
        return "headers";
    }
    return "";
}

std::string set_in_group(const std::string& key, const std::string& value, Group& group) {
    return net::set(group_setters(), key, value, group);
}

std::string set_in_scenario(const std::string& key, const std::string& value, Scenario& scenario) {
    return net::set(scenario_setters(), key, value, scenario);
}

std::string set_in_target(const std::string& key, const std::string& value, Scenario& scenario) {
    return net::set(target_setters(), key, value, scenario);
}

std::string add_threshold(const std::string& key, const std::string& value, std::vector<Threshold>& thresholds) {
    double limit = 0.0;
    const std::optional<Threshold> threshold = threshold_of(key, limit);
    if (!threshold) {
        return "no such threshold; there are " + threshold_names();
    }
    Problem problem = read_number(value, 0.0, 1e12, limit);
    thresholds.push_back(*threshold);
    thresholds.back().limit = limit;
    return problem;
}

} // namespace fieldcast::client::load
