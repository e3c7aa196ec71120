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
    /// `gate` and `metrics` must outlive it.
    LightFieldService(std::vector<std::shared_ptr<feed::Feed>> channels, const session::Limits& limits,
                      const access::Gate& gate, ServiceMetrics& metrics);

    grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* Open(grpc::CallbackServerContext* context) override;

    SessionTable& sessions() { return sessions_; }

private:
    void collect(metrics::Page& page);

    const std::vector<std::shared_ptr<feed::Feed>> channels_;
    const session::Limits limits_;
    const access::Gate& gate_;
    ServiceMetrics& metrics_;
    SessionTable sessions_;
    Guarded<RateLimit> refusal_log_;
    metrics::Collector collector_; ///< last: reads the sessions
};

} // namespace fieldcast::service
