// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/convert.h"
#include "server/feed/feed.h"

#include "fieldcast/v1/light_field.pb.h"

#include <memory>
#include <string>

namespace fieldcast::session {

/// What a client gets: one value for everything that a Configure may leave open.
struct Configuration {
    std::shared_ptr<feed::Feed> feed;
    DeliveryMode mode = DeliveryMode::kViews;
    wire::ViewSet view_set;
    feed::Selection selection;
    float frames_per_second = 30.0F;       ///< at most
    std::uint64_t max_bytes_in_flight = 0; ///< a single larger frame may be sent alone
    std::uint32_t chunk_bytes = wire::kDefaultChunkBytes;
    bool keeps_key_frames = false; ///< strips may refer to them
};

/// Why a client does not get the configuration that it asked for.
struct Refusal {
    v1::RefusalReason reason = v1::REFUSAL_REASON_INVALID;
    std::string field;   ///< name of the field of Configure that has to change; empty: none
    std::string message; ///< value that was asked for, and values that are allowed
};

/// The message that announces `configuration`. `credits`: frames that may be in flight at first.
v1::Configured to_message(const Configuration& configuration, std::uint32_t request_id, std::uint32_t epoch,
                          std::uint32_t credits);

/// The answer to the Configure with that `request_id`.
v1::Refused to_message(const Refusal& refusal, std::uint32_t request_id);

} // namespace fieldcast::session
