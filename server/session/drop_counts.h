// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fieldcast::session {

/// Why a client did not get a frame of its channel.
enum class DropReason : std::uint8_t {
    kSending,      ///< an older frame was still being sent
    kNoCredit,     ///< too many frames or bytes unacknowledged
    kRateCap,      ///< the client asked for fewer frames per second
    kReconfigured, ///< the frame was made for an earlier configuration, or aborted because of a new one
    kLeaving,      ///< the server had sent GoingAway
    kNoKeyFrame,   ///< the frame refers to a key frame that the client did not get
    kNoBudget,     ///< too many bytes unacknowledged by its peer, or by all peers together
};
inline constexpr std::size_t kDropReasonCount = 7;
inline constexpr std::array<std::string_view, kDropReasonCount> kDropReasonNames{
    "sending", "no_credit", "rate_cap", "reconfigured", "leaving", "no_key_frame", "no_budget"};

/// Dropped frames of one session by reason.
class DropCounts {
public:
    void add(DropReason reason) { ++counts_[static_cast<std::size_t>(reason)]; }
    void subtract(const DropCounts& earlier) {
        for (std::size_t i = 0; i < kDropReasonCount; ++i) {
            counts_[i] -= earlier.counts_[i];
        }
    }
    std::uint64_t of(DropReason reason) const { return counts_[static_cast<std::size_t>(reason)]; }

private:
    std::array<std::uint64_t, kDropReasonCount> counts_{};
};

} // namespace fieldcast::session
