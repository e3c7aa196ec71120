// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/convert.h"
#include "server/feed/feed.h"
#include "server/session/limits.h"

#include "fieldcast/v1/light_field.pb.h"

#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace fieldcast::session {

/// What a client gets: the chosen values for everything that a Configure may leave open.
struct Configuration {
    std::shared_ptr<feed::Feed> feed;
    DeliveryMode mode = DeliveryMode::kViews;
    wire::ViewSet view_set;
    feed::Selection selection;
    float frames_per_second = 30.0F;
    std::uint64_t max_bytes_in_flight = 0;
    std::uint32_t chunk_bytes = wire::kDefaultChunkBytes;
    bool keeps_key_frames = false; ///< strips may refer to them
};

struct Refusal {
    v1::RefusalReason reason = v1::REFUSAL_REASON_INVALID;
    std::string field;   ///< of Configure
    std::string message; ///< what was asked and what is allowed
};

using Channels = std::span<const std::shared_ptr<feed::Feed>>;

/// Chooses a configuration, or says what is wrong. Only looks: admission is up to the feed.
tl::expected<Configuration, Refusal> negotiate(const v1::Configure& asked, Channels channels, const Limits& limits);

/// The planes that a client gets of every frame in that mode, in their order.
std::vector<PlaneSemantic> asked_planes(const v1::Configure& wanted, DeliveryMode mode);

/// What is wanted for that plane; null: nothing in particular.
const v1::CodecPreference* find_preference(const v1::Configure& wanted, PlaneSemantic semantic);

/// `configuration` for the client.
v1::Configured to_message(const Configuration& configuration, std::uint32_t request_id, std::uint32_t epoch,
                          std::uint32_t credits);

v1::Refused to_message(const Refusal& refusal, std::uint32_t request_id);

} // namespace fieldcast::session
