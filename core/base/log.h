// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

namespace fieldcast::log {

enum class Level { kDebug, kInfo, kWarn, kError };

/// One `key=value` of a log line.
struct Field {
    std::string_view key;
    std::string value;
    bool is_text = true; ///< false: a number, true or false

    Field(std::string_view k, std::string_view v) : key(k), value(v) {}
    Field(std::string_view k, const char* v) : key(k), value(v) {}
    Field(std::string_view k, const std::string& v) : key(k), value(v) {}
    Field(std::string_view k, bool v) : key(k), value(v ? "true" : "false"), is_text(false) {}
    template <std::integral T> Field(std::string_view k, T v) : key(k), value(std::to_string(v)), is_text(false) {}
    Field(std::string_view k, double v);
};
using Fields = std::initializer_list<Field>;

enum class Format {
    kText, ///< local time, level, event, key=value pairs (values with spaces or control characters are quoted)
    kJson, ///< one object per line: time (UTC), level, event, and each field under its key
};

/// Lines are written to standard error.
/// Levels: error: an operator must act; warn: degraded; info: lifecycle; debug: per frame. Thread-safe.
void set_level(Level level);
void set_format(Format format);
void debug(std::string_view event, Fields fields = {});
void info(std::string_view event, Fields fields = {});
void warn(std::string_view event, Fields fields = {});
void error(std::string_view event, Fields fields = {});

} // namespace fieldcast::log
