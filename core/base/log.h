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

    Field(std::string_view k, std::string_view v) : key(k), value(v) {}
    Field(std::string_view k, const char* v) : key(k), value(v) {}
    Field(std::string_view k, const std::string& v) : key(k), value(v) {}
    Field(std::string_view k, bool v) : key(k), value(v ? "true" : "false") {}
    template <std::integral T> Field(std::string_view k, T v) : key(k), value(std::to_string(v)) {}
    Field(std::string_view k, double v);
};
using Fields = std::initializer_list<Field>;

/// Lines go to standard error: time, level, event, key=value pairs (values with spaces or control characters are quoted).
/// error: someone must act; warn: degraded; info: lifecycle; debug: per frame. Thread-safe.
void set_level(Level level);
void debug(std::string_view event, Fields fields = {});
void info(std::string_view event, Fields fields = {});
void warn(std::string_view event, Fields fields = {});
void error(std::string_view event, Fields fields = {});

} // namespace fieldcast::log
