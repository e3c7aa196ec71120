// SPDX-License-Identifier: Apache-2.0
#include "server/web/connection_table.h"

#include <algorithm>

namespace fieldcast::web {

ConnectionTable::Id ConnectionTable::add(const std::string& network) {
    entries_.push_back({.id = next_id_, .network = network});
    return next_id_++;
}

void ConnectionTable::move_to(Id id, Stage stage) {
    const auto entry = std::ranges::find(entries_, id, &Entry::id);
    if (entry != entries_.end()) {
        entry->stage = stage;
    }
}

void ConnectionTable::remove(Id id) {
    std::erase_if(entries_, [id](const Entry& entry) { return entry.id == id; });
}

std::size_t ConnectionTable::count_of(const std::string& network) const {
    return static_cast<std::size_t>(std::ranges::count(entries_, network, &Entry::network));
}

std::optional<ConnectionTable::Id> ConnectionTable::first_of_largest(std::span<const Entry> candidates) const {
    const Entry* first = nullptr;
    std::size_t first_count = 0;
    for (const Entry& entry : candidates) {
        const std::size_t count = count_of(entry.network);
        if (first == nullptr || count > first_count || (count == first_count && entry.stage < first->stage)) {
            first = &entry;
            first_count = count;
        }
    }
    return first == nullptr ? std::nullopt : std::optional(first->id);
}

std::optional<ConnectionTable::Id> ConnectionTable::surplus() const {
    if (entries_.empty()) {
        return std::nullopt;
    }
    const Entry& newest = entries_.back();
    const auto others = std::span(entries_).first(entries_.size() - 1);
    if (count_of(newest.network) > limits_.per_network) {
        std::vector<Entry> neighbours;
        std::ranges::copy_if(others, std::back_inserter(neighbours),
                             [&](const Entry& entry) { return entry.network == newest.network; });
        return first_of_largest(neighbours);
    }
    return entries_.size() > limits_.total ? first_of_largest(others) : std::nullopt;
}

} // namespace fieldcast::web
