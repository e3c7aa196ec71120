// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>

// Feeds for one client alone: a channel with own cameras opens one for every session that configures it.
namespace fieldcast::feed {

class Feed;
class OwnFeed;

/// Load that one client puts on its own camera.
struct CameraLoad {
    float frames_per_second = 0.0F;
    std::uint64_t view_pixels = 0; ///< in all views that the server makes, per frame

    bool operator==(const CameraLoad&) const = default;
};

/// Opens feeds of a channel. Thread-safe; nothing here waits for a device.
class FeedOpener : public std::enable_shared_from_this<FeedOpener> {
public:
    virtual ~FeedOpener() = default;

    /// A feed for the caller alone; its frames begin when its camera is ready. On refusal, the reason names the amount
    /// that was asked for and the amount that is left. `replaced`, if any, is a feed of this or another channel of the
    /// same server that the caller closes once it has the new one: its resources count as free, and its camera ends
    /// before the new one is made.
    virtual tl::expected<OwnFeed, std::string> open(const CameraLoad& load, const OwnFeed* replaced = nullptr) = 0;

    /// Longest time that the subscriber of an open feed has been waiting for a frame; 0: none is waiting.
    virtual std::chrono::nanoseconds waiting_time(std::chrono::steady_clock::time_point now) = 0;

private:
    friend class OwnFeed;
    /// Changes the load of an open feed. Returns the reason of a refusal, after which the old load stays.
    virtual std::optional<std::string> change(std::uint64_t id, const CameraLoad& load) = 0;
    virtual void close(std::uint64_t id) = 0;
};

/// An open feed; closes when destroyed.
class OwnFeed {
public:
    OwnFeed() = default; ///< not open
    OwnFeed(std::shared_ptr<FeedOpener> opener, std::uint64_t id, std::shared_ptr<Feed> feed)
        : opener_(std::move(opener)), id_(id), feed_(std::move(feed)) {}
    OwnFeed(OwnFeed&& other) noexcept
        : opener_(std::move(other.opener_)), id_(other.id_), feed_(std::move(other.feed_)) {}
    OwnFeed& operator=(OwnFeed&& other) noexcept {
        if (this != &other) {
            close();
            opener_ = std::move(other.opener_);
            id_ = other.id_;
            feed_ = std::move(other.feed_);
        }
        return *this;
    }
    ~OwnFeed() { close(); }

    std::uint64_t id() const { return id_; }                              ///< unique in a server
    const std::shared_ptr<Feed>& feed() const { return feed_; }           ///< null: not open
    const std::shared_ptr<FeedOpener>& opener() const { return opener_; } ///< null: not open

    /// Changes the load. Returns the reason of a refusal, after which the old load stays; empty: changed.
    std::optional<std::string> change(const CameraLoad& load) { return opener_->change(id_, load); }

    void close() {
        if (opener_ != nullptr) {
            opener_->close(id_);
            opener_.reset();
            feed_.reset();
        }
    }

private:
    std::shared_ptr<FeedOpener> opener_;
    std::uint64_t id_ = 0;
    std::shared_ptr<Feed> feed_;
};

} // namespace fieldcast::feed
