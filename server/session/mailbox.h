// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

namespace fieldcast::session {

/// Holds one item, the newest: a slow reader gets fresh items, and memory is bounded. Not thread-safe.
template <class T> class Mailbox {
public:
    /// Returns the item that was replaced, if there was one.
    std::optional<T> put(T item) { return std::exchange(item_, std::optional<T>(std::move(item))); }

    /// The item, which stays in the mailbox; null if there is none.
    const T* peek() const { return item_ ? &*item_ : nullptr; }

    /// Removes and returns the item, if there is one.
    std::optional<T> take() { return std::exchange(item_, std::nullopt); }

private:
    std::optional<T> item_;
};

} // namespace fieldcast::session
