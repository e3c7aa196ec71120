// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/service/session_table.h"

#include "fieldcast/v1/light_field.grpc.pb.h"

#include <memory>
#include <vector>

namespace fieldcast::service {

/// LightField.Open on raw bytes, so that encoded chunks are shared by all clients instead of being copied.
class LightFieldService final : public v1::LightField::WithRawCallbackMethod_Open<v1::LightField::Service> {
public:
    /// `gate` must outlive it.
    LightFieldService(std::vector<std::shared_ptr<feed::Feed>> channels, const session::Limits& limits,
                      const access::Gate& gate)
        : channels_(std::move(channels)), limits_(limits), gate_(gate), sessions_(limits) {}

    grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* Open(grpc::CallbackServerContext* context) override;

    SessionTable& sessions() { return sessions_; }

private:
    const std::vector<std::shared_ptr<feed::Feed>> channels_;
    const session::Limits limits_;
    const access::Gate& gate_;
    SessionTable sessions_;
};

} // namespace fieldcast::service
