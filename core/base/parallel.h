// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace fieldcast {

/// A few threads for loops over independent items (strips of planes, views).
///
///     WorkerPool pool(4);
///     pool.for_each(strips.size(), [&](std::size_t i) { strips[i] = encode_strip(...); });
class WorkerPool {
public:
    /// `thread_count` includes the calling thread: 1 starts none. 0: one per hardware thread.
    explicit WorkerPool(unsigned thread_count = 0);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    unsigned thread_count() const { return thread_count_; }

    /// Calls `work(0)` … `work(count − 1)`, in any order, on all threads; returns when all are done. The calling thread
    /// works too. An exception stops further items and is rethrown here. Several threads may call this: they take
    /// turns. `work` must not call it on the same pool.
    void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

private:
    void serve(const std::stop_token& stop);
    void work_on_loop(std::unique_lock<std::mutex>& lock);

    unsigned thread_count_;
    std::mutex turn_; ///< held by the caller whose loop runs; taken before `mutex_`
    std::mutex mutex_;
    std::condition_variable_any loop_started_;
    std::condition_variable_any loop_finished_;
    const std::function<void(std::size_t)>* work_ = nullptr; ///< of the running loop
    std::size_t count_ = 0;
    std::size_t next_ = 0;    ///< first item that no thread has taken
    std::size_t running_ = 0; ///< items taken and not finished
    std::exception_ptr failure_;
    std::vector<std::jthread> helpers_;
};

} // namespace fieldcast
