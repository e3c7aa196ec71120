// SPDX-License-Identifier: Apache-2.0
#include "core/base/log.h"

#include "core/base/json_text.h"
#include "core/base/printable.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace fieldcast::log {

namespace {

constexpr const char* kTextPattern = "%Y-%m-%dT%H:%M:%S.%e %-7l %v";
constexpr std::size_t kMaxValueBytes = 64U << 10;
std::atomic<bool> is_json = false;

spdlog::logger& logger() {
    static const auto instance = [] {
        auto created = std::make_shared<spdlog::logger>("fieldcast", std::make_shared<spdlog::sinks::stderr_sink_mt>());
        created->set_pattern(kTextPattern);
        return created;
    }();
    return *instance;
}

void append_value(std::string& line, const std::string& raw) {
    const std::string value = printable(raw, kMaxValueBytes);
    const auto needs_quotes = [](char c) { return c == ' ' || c == '=' || c == '"'; };
    if (!value.empty() && std::ranges::none_of(value, needs_quotes)) {
        line += value;
        return;
    }
    line += '"';
    for (const char c : value) {
        if (c == '"' || c == '\\') {
            line += '\\';
        }
        line += c;
    }
    line += '"';
}

std::string text_line(std::string_view event, Fields fields) {
    std::string line(event);
    for (const Field& field : fields) {
        line += ' ';
        line += field.key;
        line += '=';
        append_value(line, field.value);
    }
    return line;
}

/// 2026-07-31T12:00:00.123Z
std::string utc_now() {
    const auto now = std::chrono::system_clock::now();
    const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    std::array<char, 32> date{};
    std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &parts);
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%s.%03dZ", date.data(), static_cast<int>(ms));
    return text.data();
}

std::string json_line(std::string_view level, std::string_view event, Fields fields) {
    std::string line =
        "{\"time\":" + json_text(utc_now()) + ",\"level\":" + json_text(level) + ",\"event\":" + json_text(event);
    for (const Field& field : fields) {
        const bool is_word = field.value == "inf" || field.value == "-inf" || field.value.ends_with("nan");
        line += ',';
        line += json_text(field.key);
        line += ':';
        line += field.is_text || is_word ? json_text(field.value) : field.value;
    }
    return line + "}";
}

void write(spdlog::level::level_enum level, std::string_view event, Fields fields) {
    if (!logger().should_log(level)) {
        return;
    }
    const auto name = spdlog::level::to_string_view(level);
    const std::string line = is_json ? json_line({name.data(), name.size()}, event, fields) : text_line(event, fields);
    logger().log(level, spdlog::string_view_t(line));
}

} // namespace

Field::Field(std::string_view k, double v) : key(k), is_text(false) {
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

void set_format(Format format) {
    is_json = format == Format::kJson;
    logger().set_pattern(is_json ? "%v" : kTextPattern);
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
