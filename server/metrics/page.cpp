// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/page.h"

#include <array>
#include <charconv>
#include <cmath>

namespace fieldcast::metrics {

namespace {

std::string number_text(double value) {
    if (std::isnan(value)) {
        return "NaN";
    }
    if (std::isinf(value)) {
        return value > 0.0 ? "+Inf" : "-Inf";
    }
    std::array<char, 40> buffer{};
    const double size = std::abs(value);
    const bool is_handy = size == 0.0 || (size >= 1e-6 && size < 1e17);
    const auto format = is_handy ? std::chars_format::fixed : std::chars_format::scientific;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format);
    return {buffer.data(), error == std::errc{} ? end : buffer.data()};
}

std::string escaped(const std::string& value) {
    std::string text;
    for (const char c : value) {
        text += c == '\\' ? "\\\\" : c == '"' ? "\\\"" : c == '\n' ? "\\n" : std::string(1, c);
    }
    return text;
}

std::string label_text(const Labels& labels) {
    std::string text;
    for (const auto& [name, value] : labels) {
        text += text.empty() ? "{" : ",";
        text += name;
        text += "=\"" + escaped(value) + "\"";
    }
    return text.empty() ? text : text + "}";
}

std::string line(const std::string& name, const Labels& labels, double value) {
    return name + label_text(labels) + " " + number_text(value) + "\n";
}

} // namespace

Page::Family& Page::family(const Description& what, const char* type) {
    Family& family = families_[what.name];
    family.help = what.help;
    family.type = type;
    return family;
}

void Page::add_counter(const Description& what, const Labels& labels, double value) {
    family(what, "counter").samples += line(what.name, labels, value);
}

void Page::add_gauge(const Description& what, const Labels& labels, double value) {
    family(what, "gauge").samples += line(what.name, labels, value);
}

void Page::add_histogram(const Description& what, const Labels& labels, const Histogram& histogram) {
    std::string& samples = family(what, "histogram").samples;
    const std::vector<std::uint64_t> counts = histogram.cumulative_counts();
    for (std::size_t i = 0; i < counts.size(); ++i) {
        Labels with_bound(labels);
        const bool is_last = i == histogram.bounds().size();
        with_bound.emplace_back("le", is_last ? "+Inf" : number_text(histogram.bounds()[i]));
        samples += line(what.name + "_bucket", with_bound, static_cast<double>(counts[i]));
    }
    samples += line(what.name + "_sum", labels, histogram.sum());
    samples += line(what.name + "_count", labels, static_cast<double>(counts.back()));
}

std::string Page::text() const {
    std::string text;
    for (const auto& [name, family] : families_) {
        text += "# HELP " + name + " " + family.help + "\n# TYPE " + name + " " + family.type + "\n" + family.samples;
    }
    return text;
}

} // namespace fieldcast::metrics
