// SPDX-License-Identifier: Apache-2.0
#include "server/service/download_table.h"

#include "server/session/budget.h"

#include <algorithm>

namespace fieldcast::service {

namespace {

constexpr std::string_view kRefused = "refused";

metrics::Counter& ended_counter(metrics::Registry& registry, std::string_view result) {
    return registry.counter({"fieldcast_scene_downloads_total",
                            "Scene downloads that ended or were refused, by result."},
                            {{"result", std::string(result)}});
}

} // namespace

DownloadTable::DownloadTable(const session::Limits& limits, metrics::Registry& registry)
    : limits_(limits), registry_(registry),
      bytes_(registry.counter({"fieldcast_scene_bytes_total", "Sent bytes of scenes."}, {})),
      collector_(registry.on_collect([this](metrics::Page& page) {
          const auto count = static_cast<double>(state_.lock()->places.size());
          page.add_gauge({"fieldcast_scene_downloads", "Running scene downloads."}, {}, count);
      })) {
    for (const std::string_view result : kCallEndNames) {
        ended_counter(registry_, result);
    }
    ended_counter(registry_, kRefused);
}

tl::expected<std::uint64_t, std::string> DownloadTable::admit(const std::string& peer) {
    const auto refuse = [&](std::uint32_t limit, const char* whose) {
        ended_counter(registry_, kRefused).add();
        return tl::unexpected("all " + std::to_string(limit) + " scene downloads that " + whose +
                              " at the same time are in use");
    };
    auto state = state_.lock();
    if (state->places.size() >= limits_.max_scene_downloads) {
        return refuse(limits_.max_scene_downloads, "this server serves");
    }
    const auto of_peer = std::ranges::count_if(state->places, [&](const auto& p) { return p.second == peer; });
    if (static_cast<std::uint64_t>(of_peer) >= limits_.max_scene_downloads_per_peer) {
        return refuse(limits_.max_scene_downloads_per_peer, "one peer may have");
    }
    const auto kept = session::newcomers_reserve(limits_.max_scene_downloads, limits_.max_scene_downloads_per_peer);
    if (of_peer > 0 && state->places.size() + kept >= limits_.max_scene_downloads) {
        return refuse(limits_.max_scene_downloads, "this server serves (some of them reserved for new peers)");
    }
    const std::uint64_t id = state->next_id++;
    state->places.emplace(id, peer);
    return id;
}

void DownloadTable::remove(std::uint64_t id, CallEnd end, std::uint64_t bytes_sent) {
    bytes_.add(bytes_sent);
    ended_counter(registry_, kCallEndNames.at(static_cast<std::size_t>(end))).add();
    state_.lock()->places.erase(id);
}

} // namespace fieldcast::service
