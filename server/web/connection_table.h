// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/web/limits.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::web {

/// Progress of an exchange. If a connection must be closed, those of the first stage are closed first.
enum class Stage : std::uint8_t {
    kParting,   ///< has received its answer
    kAsking,    ///< performs the handshake or sends its request
    kAnswering, ///< is receiving its answer
};

/// The open connections, and the choice of the one to close when there are too many. The newest one is never chosen, so
/// that silent connections cannot block new ones. Not thread-safe.
class ConnectionTable {
public:
    using Id = std::uint64_t;

    explicit ConnectionTable(const ConnectionLimits& limits) : limits_(limits) {}

    Id add(const std::string& network);
    void move_to(Id id, Stage stage);
    void remove(Id id); ///< does nothing if there is no such connection

    /// The connection to close if there is one too many: one of the newest connection's network if that network has too
    /// many, else of the network with most connections. Among those, the earliest stage and then the oldest is chosen.
    std::optional<Id> surplus() const;

    /// The connection to close, chosen from all in the same order, to make room for one that is not in the table yet.
    std::optional<Id> first_to_go() const { return first_of_largest(entries_); }

private:
    struct Entry {
        Id id = 0;
        std::string network;
        Stage stage = Stage::kAsking;
    };
    std::size_t count_of(const std::string& network) const;
    std::optional<Id> first_of_largest(std::span<const Entry> candidates) const;

    ConnectionLimits limits_;
    Id next_id_ = 1;
    std::vector<Entry> entries_; ///< in the order of arrival
};

} // namespace fieldcast::web
