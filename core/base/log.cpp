// SPDX-License-Identifier: Apache-2.0
#include "core/base/log.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace fieldcast::log {

namespace {

spdlog::logger& logger() {
    static const auto instance = [] {
        auto created = std::make_shared<spdlog::logger>("fieldcast", std::make_shared<spdlog::sinks::stderr_sink_mt>());
        created->set_pattern("%Y-%m-%dT%H:%M:%S.%e %-7l %v");
        return created;
    }();
    return *instance;
}

bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
}

void append_value(std::string& line, const std::string& value) {
    const auto needs_quotes = [](char c) { return c == ' ' || c == '=' || c == '"' || is_control(c); };
    if (!value.empty() && std::ranges::none_of(value, needs_quotes)) {
        line += value;
        return;
    }
    line += '"';
    for (const char c : value) {
        if (c == '"' || c == '\\') {
            line += '\\';
        }
        line += is_control(c) ? ' ' : c;
    }
    line += '"';
}

void write(spdlog::level::level_enum level, std::string_view event, Fields fields) {
    if (!logger().should_log(level)) {
        return;
    }
    std::string line(event);
    for (const Field& field : fields) {
        line += ' ';
        line += field.key;
        line += '=';
        append_value(line, field.value);
    }
    logger().log(level, spdlog::string_view_t(line));
}

} // namespace

Field::Field(std::string_view k, double v) : key(k) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", v);
    value = buffer;
}

void set_level(Level level) {
    switch (level) {
    case Level::kDebug:
        return logger().set_level(spdlog::level::debug);
    case Level::kInfo:
        return logger().set_level(spdlog::level::info);
    case Level::kWarn:
        return logger().set_level(spdlog::level::warn);
    case Level::kError:
        return logger().set_level(spdlog::level::err);
    }
}

void debug(std::string_view event, Fields fields) {
    write(spdlog::level::debug, event, fields);
}
void info(std::string_view event, Fields fields) {
    write(spdlog::level::info, event, fields);
}
void warn(std::string_view event, Fields fields) {
    write(spdlog::level::warn, event, fields);
}
void error(std::string_view event, Fields fields) {
    write(spdlog::level::err, event, fields);
}

} // namespace fieldcast::log
