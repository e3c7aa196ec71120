// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace fieldcast::channel {

/// Passes items from one thread to another, one at a time: the giver waits until the previous item was taken.
template <class T> class Handoff {
public:
    /// False: stopped, and the item is lost.
    bool put(T item, const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        if (!changed_.wait(lock, stop, [&] { return !item_.has_value(); })) {
            return false;
        }
        item_ = std::move(item);
        changed_.notify_all();
        return true;
    }

    /// Empty: stopped.
    std::optional<T> take(const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        if (!changed_.wait(lock, stop, [&] { return item_.has_value(); })) {
            return std::nullopt;
        }
        changed_.notify_all();
        return std::exchange(item_, std::nullopt);
    }

private:
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::optional<T> item_;
};

} // namespace fieldcast::channel
