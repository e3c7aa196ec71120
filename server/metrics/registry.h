// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/metrics/page.h"

#include <functional>
#include <map>
#include <memory>

namespace fieldcast::metrics {

class Registry;

/// Keeps a function on a registry's list while it lives.
class Collector {
public:
    Collector() = default;
    Collector(Collector&& other) noexcept;
    Collector& operator=(Collector&& other) noexcept;
    ~Collector() { end(); }

    /// When it returns, the function is not running and will not be called again.
    void end();

private:
    friend class Registry;
    Collector(Registry& registry, std::uint64_t id) : registry_(&registry), id_(id) {}

    Registry* registry_ = nullptr;
    std::uint64_t id_ = 0;
};

/// All numbers of one server. Thread-safe. Instruments are made once and stay; keep the references.
///
///     Counter& opened = registry.counter({"fieldcast_sessions_opened_total", "Sessions that were admitted."}, {});
class Registry {
public:
    /// The same name and labels give the same instrument. Series without an event are written as 0.
    Counter& counter(const Description& what, const Labels& labels);
    Histogram& histogram(const Description& what, const Labels& labels, std::span<const double> bounds);

    /// `collect` adds what is only known when somebody looks. It may count, and must not add or end collectors.
    [[nodiscard]] Collector on_collect(std::function<void(Page&)> collect);

    Page page();

private:
    friend class Collector;
    template <class Instrument> struct Series {
        std::string help;
        std::unique_ptr<Instrument> instrument; ///< at a fixed address
    };
    using Key = std::pair<std::string, Labels>; ///< name and labels
    struct State {
        std::map<Key, Series<Counter>> counters;
        std::map<Key, Series<Histogram>> histograms;
    };
    struct Collecting {
        std::map<std::uint64_t, std::function<void(Page&)>> functions;
        std::uint64_t next_id = 1;
    };

    Guarded<State> state_;
    Guarded<Collecting> collecting_;
};

} // namespace fieldcast::metrics
