// SPDX-License-Identifier: Apache-2.0
#include "core/scene/load_report.h"

#include "core/base/error.h"

namespace fieldcast::scene {

namespace {

constexpr std::size_t kMaxShownName = 60;
constexpr std::size_t kMaxKinds = 32;

std::string shown(std::string_view name) {
    std::string text(name.substr(0, kMaxShownName));
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
            c = '?';
        }
    }
    return name.size() > kMaxShownName ? text + "..." : text;
}

} // namespace

void refuse(const std::string& file, const std::string& object, const std::string& reason) {
    throw UserError(file + ": " + object + ": " + reason);
}

std::string object_name(std::string_view kind, std::size_t index, std::string_view name) {
    std::string text = std::string(kind) + " " + std::to_string(index);
    if (!name.empty()) {
        text += " '" + shown(name) + "'";
    }
    return text;
}

void LoadWarnings::add(const std::string& what, const std::string& unit) {
    const std::pair key(what, unit);
    if (counts_.size() < kMaxKinds || counts_.contains(key)) {
        ++counts_[key];
    }
}

std::vector<std::string> LoadWarnings::lines() const {
    std::vector<std::string> lines;
    for (const auto& [key, count] : counts_) {
        const auto& [what, unit] = key;
        const std::string shown_count = " (" + std::to_string(count) + " " + unit + (count == 1 ? ")" : "s)");
        lines.push_back(unit.empty() ? what : what + shown_count);
    }
    return lines;
}

} // namespace fieldcast::scene
