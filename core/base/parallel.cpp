// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <algorithm>
#include <utility>

namespace fieldcast {

WorkerPool::WorkerPool(unsigned thread_count)
    : thread_count_(thread_count != 0 ? thread_count : std::max(1U, std::thread::hardware_concurrency())) {
    for (unsigned helper = 1; helper < thread_count_; ++helper) {
        helpers_.emplace_back([this](const std::stop_token& stop) { serve(stop); });
    }
}

WorkerPool::~WorkerPool() {
    for (std::jthread& helper : helpers_) {
        helper.request_stop(); // all at once, so that the joins of their destructors do not add up
    }
}

void WorkerPool::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
    const std::lock_guard turn(turn_);
    std::unique_lock lock(mutex_);
    work_ = &work;
    count_ = count;
    next_ = 0;
    failure_ = nullptr;
    if (count > 1) {
        loop_started_.notify_all();
    }
    work_on_loop(lock);
    loop_finished_.wait(lock, [this] { return running_ == 0; });
    work_ = nullptr;
    if (failure_) {
        std::rethrow_exception(std::exchange(failure_, nullptr));
    }
}

void WorkerPool::serve(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (loop_started_.wait(lock, stop, [this] { return work_ != nullptr && next_ < count_; })) {
        work_on_loop(lock);
    }
}

void WorkerPool::work_on_loop(std::unique_lock<std::mutex>& lock) {
    while (next_ < count_) {
        const std::size_t item = next_++;
        ++running_;
        const auto& work = *work_;
        lock.unlock();
        std::exception_ptr failure;
        try {
            work(item);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        --running_;
        if (failure) {
            failure_ = failure;
            next_ = count_;
        }
    }
    if (running_ == 0) {
        loop_finished_.notify_all();
    }
}

} // namespace fieldcast
