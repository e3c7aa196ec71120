// SPDX-License-Identifier: Apache-2.0
#include "server/service/health_probe.h"

#include "core/base/printable.h"
#include "server/access/text_file.h"

#include <future>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>

namespace fieldcast::service {

namespace {

constexpr std::size_t kMaxPemBytes = 4U << 20;
constexpr const char* kCheck = "/grpc.health.v1.Health/Check";

std::string pem_of(const std::filesystem::path& file) {
    return file.empty() ? "" : access::read_text_file(file, kMaxPemBytes);
}

std::shared_ptr<grpc::Channel> dial(const HealthQuestion& question) {
    grpc::ChannelArguments arguments;
    if (!question.name.empty()) {
        arguments.SetSslTargetNameOverride(question.name);
    }
    const auto credentials = question.uses_tls ? grpc::SslCredentials({.pem_root_certs = pem_of(question.ca),
                                                                       .pem_private_key = pem_of(question.key),
                                                                       .pem_cert_chain = pem_of(question.certificate)})
                                               : grpc::InsecureChannelCredentials();
    return grpc::CreateCustomChannel(to_text(question.address), credentials, arguments);
}

/// Parses HealthCheckResponse, whose only field has number 1 and is an enum; SERVING is 1.
std::optional<std::string> problem_of(const grpc::ByteBuffer& answer) {
    grpc::Slice bytes;
    const bool is_readable = answer.DumpToSingleSlice(&bytes).ok();
    const std::string text(reinterpret_cast<const char*>(bytes.begin()), is_readable ? bytes.size() : 0);
    if (text == "\x08\x01") {
        return std::nullopt;
    }
    return text == "\x08\x02" ? "NOT_SERVING" : "an answer that is neither SERVING nor NOT_SERVING";
}

grpc::Status ask(grpc::GenericStub& stub, const HealthQuestion& question, grpc::ByteBuffer& answer) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + question.timeout);
    if (!question.token.empty()) {
        context.AddMetadata("authorization", "Bearer " + question.token);
    }
    const grpc::Slice nothing("");
    const grpc::ByteBuffer request(&nothing, 1);                       // HealthCheckRequest: the whole server
    const auto ended = std::make_shared<std::promise<grpc::Status>>(); // the reaction may outlive this function
    stub.UnaryCall(&context, kCheck, grpc::StubOptions(), &request, &answer,
                   [ended](const grpc::Status& status) { ended->set_value(status); });
    return ended->get_future().get();
}

} // namespace

std::optional<std::string> health_problem(const HealthQuestion& question) {
    // gRPC 1.51 sometimes reports a connection that is still being established as failed, so the call is repeated.
    constexpr int kAttempts = 3;
    grpc::GenericStub stub(dial(question));
    grpc::ByteBuffer answer;
    grpc::Status status = ask(stub, question, answer);
    for (int i = 1; i < kAttempts && status.error_code() == grpc::StatusCode::UNAVAILABLE; ++i) {
        status = ask(stub, question, answer);
    }
    return status.ok() ? problem_of(answer) : std::optional(to_text(question.address) + ": " + printable(status.error_message()));
}

} // namespace fieldcast::service
