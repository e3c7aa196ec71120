// SPDX-License-Identifier: Apache-2.0
#include "client/setting_text.h"

#include "client/net/request_text.h"
#include "core/base/error.h"

namespace fieldcast::client {
namespace {

/// Applies `pair`, a KEY=VALUE, to `owner`; throws UserError if `setters` do not contain KEY or refuse VALUE.
template <class Owner>
void apply(const std::string& flag, const std::string& pair, const net::Setters<Owner>& setters, Owner& owner) {
    const std::size_t equals = pair.find('=');
    const std::string key = pair.substr(0, equals);
    if (equals == std::string::npos || !setters.contains(key)) {
        throw UserError(flag + ": '" + pair + "': expected KEY=VALUE with one of the keys " + net::names_of(setters));
    }
    const std::string problem = net::set(setters, key, pair.substr(equals + 1), owner);
    if (!problem.empty()) {
        throw UserError(flag + ": " + pair + ": " + problem);
    }
}

play::ChangeMoment moment_of(const std::string& flag, const std::string& text) {
    const std::size_t digits = text.find_first_not_of("0123456789.");
    const std::string unit = digits == std::string::npos ? "" : text.substr(digits);
    double value = 0.0;
    const bool is_number = net::read_number(text.substr(0, digits), 0.0, 1e9, value).empty();
    if (is_number && unit == "f") {
        return {.frames = static_cast<std::uint64_t>(value)};
    }
    if (!is_number || (unit != "s" && unit != "ms")) {
        throw UserError(flag + ": '" + text + "' is not a time; write 3s, 500ms, or 20f for a number of frames");
    }
    const double milliseconds = unit == "s" ? value * 1000.0 : value;
    return {.after = std::chrono::milliseconds(static_cast<std::int64_t>(milliseconds))};
}

} // namespace

void set_in_request(const std::string& key, const std::string& value, net::Request& request) {
    const std::string problem = net::set(net::request_setters(), key, value, request);
    if (!problem.empty()) {
        throw UserError("--" + key + " " + value + ": " + problem);
    }
}

play::Change read_change(const std::string& text, const net::Request& before) {
    const std::string flag = "--change " + text;
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) {
        throw UserError(flag + ": write WHEN:KEY=VALUE, as in 3s:grid=5x5");
    }
    play::Change change{.moment = moment_of(flag, text.substr(0, colon)), .request = before};
    for (const std::string& pair : net::split(text.substr(colon + 1), ',')) {
        apply(flag, pair, net::request_setters(), change.request);
    }
    return change;
}

net::AdaptationBounds read_adaptation(const std::string& text) {
    net::AdaptationBounds bounds;
    for (const std::string& pair : net::split(text, ',')) {
        if (!text.empty()) {
            apply("--adapt " + text, pair, net::adaptation_setters(), bounds);
        }
    }
    return bounds;
}

} // namespace fieldcast::client
