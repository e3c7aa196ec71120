// SPDX-License-Identifier: Apache-2.0
#include "core/base/log_quota.h"

#include <utility>

namespace fieldcast::log {

namespace {

void write_line(Level level, std::string_view event, Fields fields) {
    switch (level) {
    case Level::kDebug:
        return debug(event, fields);
    case Level::kInfo:
        return info(event, fields);
    case Level::kWarn:
        return warn(event, fields);
    case Level::kError:
        return error(event, fields);
    }
}

} // namespace

Quota::~Quota() {
    for (const auto& [event, lines] : *lines_.lock()) {
        tell_left_out(lines.level, event, lines.left_out);
    }
}

void Quota::write(Level level, std::string_view event, Fields fields, TimePoint now) {
    std::uint64_t left_out = 0;
    {
        auto lines = lines_.lock();
        auto found = lines->find(event);
        if (found == lines->end()) {
            found = lines->emplace(event, Lines{.rate = RateLimit(of_event_), .level = level}).first;
        }
        if (!found->second.rate.take(now)) {
            ++found->second.left_out;
            return;
        }
        left_out = std::exchange(found->second.left_out, 0);
    }
    tell_left_out(level, event, left_out);
    write_line(level, event, fields);
}

void Quota::tell_left_out(Level level, std::string_view event, std::uint64_t count) const {
    if (count > 0) {
        write_line(level, "log lines left out", {{"of", event}, {"by", owner_}, {"count", count}});
    }
}

} // namespace fieldcast::log
