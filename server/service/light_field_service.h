// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/service/session_table.h"

#include "fieldcast/v1/light_field.grpc.pb.h"

#include <memory>
#include <vector>

namespace fieldcast::service {

/// LightField.Open on raw bytes, so that all clients share encoded chunks without copies.
class LightFieldService final : public v1::LightField::WithRawCallbackMethod_Open<v1::LightField::Service> {
public:
    /// Both must outlive the service.
    struct Observers {
        ServiceMetrics* metrics = nullptr;
        timing::TimingRecorder* recorder = nullptr; ///< null: none
    };

    /// `gate` must outlive it.
    LightFieldService(std::vector<std::shared_ptr<feed::Feed>> channels, const session::Limits& limits,
                      const access::Gate& gate, const Observers& observers);

    grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* Open(grpc::CallbackServerContext* context) override;

    SessionTable& sessions() { return sessions_; }

    /// Sends GoingAway to all sessions whose token was revoked.
    void send_revoked_away();

private:
    void collect(metrics::Page& page);

    const std::vector<std::shared_ptr<feed::Feed>> channels_;
    const session::Limits limits_;
    const access::Gate& gate_;
    ServiceMetrics& metrics_;
    timing::TimingRecorder* const recorder_; ///< null: none
    log::Quota refusals_;
    log::Quota comings_; ///< lines about opened and closed sessions
    SessionTable sessions_;
    metrics::Collector collector_; ///< declared last, because it reads the sessions
};

} // namespace fieldcast::service
