// SPDX-License-Identifier: Apache-2.0
#include "core/base/flag_problem.h"

#include <algorithm>

namespace fieldcast {

namespace {

bool is_digits(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// Advice on a valid value instead of `value`.
std::string advice(const std::string& type, std::string_view value) {
    if (type == "UINT" || type == "INT") {
        return is_digits(value)  ? "this number is too large"
               : type == "UINT" ? "write a whole number, 0 or more"
                                : "write a whole number";
    }
    if (type == "FLOAT") {
        return "write a number with a point, such as 0.5";
    }
    return "write the flag alone, or with =true or =false";
}

/// "Could not convert: --flag = value"
std::string of_conversion(const std::string& said, const std::function<std::string(const std::string&)>& type_of) {
    const std::size_t flag_begin = said.find("--");
    const std::size_t flag_end = said.find(" = ", std::min(flag_begin, said.size()));
    if (flag_end == std::string::npos) {
        return said;
    }
    const std::string flag = said.substr(flag_begin, flag_end - flag_begin);
    const std::string value = said.substr(flag_end + 3);
    return flag + " " + value + ": " + advice(type_of(flag), value);
}

/// "--flag: 1 required TEXT missing", "--flag: At Most 1 required but received 2"
std::string of_count(const std::string& said) {
    const std::size_t colon = said.find(": ");
    if (colon == std::string::npos) {
        return said;
    }
    const std::string flag = said.substr(0, colon);
    if (!said.ends_with(" missing")) {
        return flag + ": is given more than once; give it once";
    }
    const std::string count = said.substr(colon + 2, said.find(' ', colon + 2) - colon - 2);
    return flag + (count == "1" ? ": needs a value after it" : ": needs " + count + " values after it");
}

} // namespace

std::string flag_problem(const std::string& kind, const std::string& said,
                         const std::function<std::string(const std::string& flag)>& type_of) {
    if (kind == "ConversionError") {
        return of_conversion(said, type_of);
    }
    return kind == "ArgumentMismatch" ? of_count(said) : said;
}

} // namespace fieldcast
