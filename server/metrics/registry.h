// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/metrics/page.h"

#include <functional>
#include <map>
#include <memory>

namespace fieldcast::metrics {

class Registry;

/// Registers a collecting function with a registry for its own lifetime.
class Collector {
public:
    Collector() = default;
    Collector(Collector&& other) noexcept;
    Collector& operator=(Collector&& other) noexcept;
    ~Collector() { end(); }

    /// After it returns, the function is not running and is not called again.
    void end();

private:
    friend class Registry;
    Collector(Registry& registry, std::uint64_t id) : registry_(&registry), id_(id) {}

    Registry* registry_ = nullptr;
    std::uint64_t id_ = 0;
};

/// All metrics of one server. Thread-safe. Instruments are never destroyed, so references to them may be kept.
///
///     Counter& opened = registry.counter({"fieldcast_sessions_opened_total", "Admitted sessions."}, {});
class Registry {
public:
    /// Returns the instrument with this name and these labels; creates it on the first call. Its value starts at 0.
    Counter& counter(const Description& what, const Labels& labels);
    Histogram& histogram(const Description& what, const Labels& labels, std::span<const double> bounds);

    /// `collect` adds values that are computed when the page is requested. It may change instruments, but must not add
    /// or remove collectors.
    [[nodiscard]] Collector on_collect(std::function<void(Page&)> collect);

    Page page();

private:
    friend class Collector;
    template <class Instrument> struct Series {
        std::string help;
        std::unique_ptr<Instrument> instrument; ///< its address never changes
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
