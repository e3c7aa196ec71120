// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace fieldcast {

/// A value that can be reached only through its lock.
/// Never send, decode or wait for the GPU while a `Lock` lives.
template <class T> class Guarded {
public:
    class Lock {
    public:
        T* operator->() { return value_; }
        T& operator*() { return *value_; }
        /// Blocks until `predicate(value)` holds; the lock is released meanwhile.
        template <class Predicate> void wait(std::condition_variable& changed, Predicate predicate) {
            changed.wait(lock_, [&] { return predicate(*value_); });
        }
        /// As `wait`, but gives up at `deadline`. Returns whether the predicate holds.
        template <class Clock, class Duration, class Predicate>
        bool wait_until(std::condition_variable& changed, std::chrono::time_point<Clock, Duration> deadline,
                        Predicate predicate) {
            return changed.wait_until(lock_, deadline, [&] { return predicate(*value_); });
        }

    private:
        friend class Guarded;
        Lock(std::mutex& mutex, T& value) : lock_(mutex), value_(&value) {}
        std::unique_lock<std::mutex> lock_;
        T* value_;
    };

    Guarded() = default;
    explicit Guarded(T value) : value_(std::move(value)) {}
    Lock lock() { return Lock(mutex_, value_); }

private:
    std::mutex mutex_;
    T value_{};
};

} // namespace fieldcast
