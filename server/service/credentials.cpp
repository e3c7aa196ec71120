// SPDX-License-Identifier: Apache-2.0
#include "server/service/credentials.h"

#include "core/base/log_quota.h"
#include "server/service/status.h"

#include <grpcpp/security/auth_metadata_processor.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>

namespace fieldcast::service {

namespace {

constexpr unsigned kCertificateRefresh_s = 1;

std::string_view view_of(const grpc::string_ref& text) {
    return {text.data(), text.size()};
}

using Headers = std::multimap<grpc::string_ref, grpc::string_ref>;

/// The value of a header; nothing if the header is absent or repeated.
std::optional<std::string_view> find(const Headers& headers, const char* name) {
    return headers.count(name) == 1 ? std::optional(view_of(headers.find(name)->second)) : std::nullopt;
}

Problem problem_of(access::Denial::Kind kind) {
    const bool is_known = kind == access::Denial::Kind::kRoleTooLow;
    return is_known ? Problem::kForbidden : Problem::kUnauthenticated;
}

/// Whether health checks need a token. On loopback they do not: supervisors and proxies on the same machine have none.
enum class HealthAccess : std::uint8_t { kWithToken, kOpen };

/// Admits or denies every call through the gate.
class TokenCheck final : public grpc::AuthMetadataProcessor {
public:
    TokenCheck(const access::Gate& gate, ServiceMetrics& metrics, HealthAccess health)
        : gate_(gate), metrics_(metrics), health_(health) {}

    bool IsBlocking() const override { return false; }

    grpc::Status Process(const InputMetadata& headers, grpc::AuthContext*, OutputMetadata*, OutputMetadata*) override {
        const std::string_view method = find(headers, ":path").value_or("");
        if (health_ == HealthAccess::kOpen && method.starts_with("/grpc.health.v1.Health/")) {
            return grpc::Status::OK;
        }
        const auto identity = gate_.admit(find(headers, "authorization"), method);
        if (identity) {
            return grpc::Status::OK;
        }
        metrics_.count_denied(identity.error().kind);
        denials_.write(log::Level::kWarn, "call denied",
                       {{"method", method.substr(0, 100)}, {"reason", identity.error().message}});
        return to_status(problem_of(identity.error().kind), identity.error().message);
    }

private:
    const access::Gate& gate_;
    ServiceMetrics& metrics_;
    const HealthAccess health_;
    log::Quota denials_{"everybody", log::Quota::kOfEverybody};
};

std::shared_ptr<grpc::ServerCredentials> tls_credentials(const access::CertificateFiles& files) {
    namespace tls = grpc::experimental;
    const std::string client_ca = files.client_ca ? files.client_ca->string() : "";
    const auto provider = std::make_shared<tls::FileWatcherCertificateProvider>(
        files.key.string(), files.certificate.string(), client_ca, kCertificateRefresh_s);
    tls::TlsServerCredentialsOptions options(provider);
    options.watch_identity_key_cert_pairs();
    if (files.client_ca) {
        options.watch_root_certs();
        options.set_cert_request_type(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
    }
    return tls::TlsServerCredentials(options);
}

} // namespace

std::shared_ptr<grpc::ServerCredentials> make_credentials(const access::Security& security, const access::Gate& gate,
                                                          ServiceMetrics& metrics) {
    std::shared_ptr<grpc::ServerCredentials> credentials;
    if (security.certificates) {
        credentials = tls_credentials(*security.certificates);
    } else if (security.tokens) { // plain text in gRPC's local credentials, which support checks of calls
        credentials = grpc::experimental::LocalServerCredentials(LOCAL_TCP);
    } else {
        return grpc::InsecureServerCredentials();
    }
    if (security.tokens) {
        const auto health = security.certificates ? HealthAccess::kWithToken : HealthAccess::kOpen; // open: on loopback
        credentials->SetAuthMetadataProcessor(std::make_shared<TokenCheck>(gate, metrics, health));
    }
    return credentials;
}

tl::expected<access::Identity, access::Denial> identify(const grpc::CallbackServerContext& context,
                                                        const access::Gate& gate) {
    return gate.admit(find(context.client_metadata(), "authorization"), "this call", access::Role::kView);
}

} // namespace fieldcast::service
