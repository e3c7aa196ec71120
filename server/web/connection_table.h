// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/web/limits.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::web {

/// How far an exchange has come. Where somebody has to go, those of the first stage go first.
enum class Stage : std::uint8_t {
    kParting,   ///< has its answer
    kAsking,    ///< shakes hands, or sends its request
    kAnswering, ///< is sent its answer
};

/// Who is connected, and who has to go when there are too many. It is never the newest one, so that callers who say
/// nothing do not keep others out. Not thread-safe.
class ConnectionTable {
public:
    using Id = std::uint64_t;

    explicit ConnectionTable(const ConnectionLimits& limits) : limits_(limits) {}

    Id add(const std::string& network);
    void move_to(Id id, Stage stage);
    void remove(Id id); ///< does nothing if it is gone

    /// Whom to cut because there is one too many: of the newest one's network, if that has too many, else of the
    /// network that has most. Of those the earliest stage goes first, and in one stage the oldest.
    std::optional<Id> surplus() const;

    /// Whom to cut of all, in the same order, so that there is room for one who is not in the table yet.
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
    std::vector<Entry> entries_; ///< in the order in which they came
};

} // namespace fieldcast::web
