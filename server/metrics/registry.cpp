// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/registry.h"

#include <type_traits>
#include <utility>

namespace fieldcast::metrics {

namespace {

/// The instrument with this name and these labels, created with `arguments` if it is new.
template <class Map, class... Arguments>
auto& find_or_make(Map& map, const Description& what, const Labels& labels, const Arguments&... arguments) {
    const auto [place, is_new] = map.try_emplace({what.name, labels});
    auto& series = place->second;
    if (is_new) {
        using Instrument = typename std::remove_reference_t<decltype(series.instrument)>::element_type;
        series.help = what.help;
        series.instrument = std::make_unique<Instrument>(arguments...);
    }
    return *series.instrument;
}

} // namespace

Collector::Collector(Collector&& other) noexcept : registry_(std::exchange(other.registry_, nullptr)), id_(other.id_) {}

Collector& Collector::operator=(Collector&& other) noexcept {
    if (this != &other) {
        end();
        registry_ = std::exchange(other.registry_, nullptr);
        id_ = other.id_;
    }
    return *this;
}

void Collector::end() {
    if (registry_ != nullptr) {
        std::exchange(registry_, nullptr)->collecting_.lock()->functions.erase(id_);
    }
}

Counter& Registry::counter(const Description& what, const Labels& labels) {
    return find_or_make(state_.lock()->counters, what, labels);
}

Histogram& Registry::histogram(const Description& what, const Labels& labels, std::span<const double> bounds) {
    return find_or_make(state_.lock()->histograms, what, labels, bounds);
}

Collector Registry::on_collect(std::function<void(Page&)> collect) {
    auto collecting = collecting_.lock();
    const std::uint64_t id = collecting->next_id++;
    collecting->functions.emplace(id, std::move(collect));
    return {*this, id};
}

Page Registry::page() {
    Page page;
    {
        auto collecting = collecting_.lock();
        for (const auto& [id, collect] : collecting->functions) {
            collect(page);
        }
    }
    auto state = state_.lock();
    for (const auto& [key, series] : state->counters) {
        page.add_counter({key.first, series.help}, key.second, static_cast<double>(series.instrument->value()));
    }
    for (const auto& [key, series] : state->histograms) {
        page.add_histogram({key.first, series.help}, key.second, *series.instrument);
    }
    return page;
}

} // namespace fieldcast::metrics
