// SPDX-License-Identifier: Apache-2.0
#include "server/service/light_field_service.h"

#include "core/base/log.h"
#include "server/service/credentials.h"
#include "server/service/messages.h"
#include "server/service/status.h"

namespace fieldcast::service {

namespace {

/// Ends a call at once.
class Refuse final : public RawReactor {
public:
    explicit Refuse(const grpc::Status& status) { Finish(status); }
    void OnDone() override { delete this; }
};

} // namespace

RawReactor* LightFieldService::Open(grpc::CallbackServerContext* context) {
    const std::string peer = context->peer();
    const auto identity = identify(*context, gate_);
    if (!identity) { // revoked in this moment
        return new Refuse(to_status(Problem::kUnauthenticated, identity.error().message));
    }
    const auto id = sessions_.admit(peer_host(peer), *identity);
    if (!id) {
        log::warn("session refused", {{"peer", peer}, {"reason", id.error().message}});
        return new Refuse(to_status(id.error().problem, id.error().message));
    }
    log::info("session opened", {{"session", *id}, {"peer", peer}, {"token", identity->name}});
    const auto stream = Stream::open(
        *context, {.channels = channels_, .limits = limits_, .id = *id, .on_done = [this](std::uint64_t done) {
                       sessions_.remove(done);
                   }});
    sessions_.add(*id, stream);
    return stream.get();
}

} // namespace fieldcast::service
