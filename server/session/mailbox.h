// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

namespace fieldcast::session {

/// Room for one item; the newest wins, so a slow reader gets fresh items and costs no memory.
template <class T> class Mailbox {
public:
    /// Returns the item that had to go, if there was one.
    std::optional<T> put(T item) { return std::exchange(item_, std::optional<T>(std::move(item))); }

    /// The item, still in the box; null if there is none.
    const T* peek() const { return item_ ? &*item_ : nullptr; }

    std::optional<T> take() { return std::exchange(item_, std::nullopt); }

private:
    std::optional<T> item_;
};

} // namespace fieldcast::session
