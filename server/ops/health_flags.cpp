// SPDX-License-Identifier: Apache-2.0
#include "server/ops/health_flags.h"

#include "core/base/bearer_token.h"
#include "core/base/error.h"

namespace fieldcast::ops {

service::HealthQuestion read_health(const HealthText& text, const std::string& certificate, const std::string& key) {
    constexpr std::string_view kEncrypted = "https://";
    service::HealthQuestion question;
    question.uses_tls = text.server.starts_with(kEncrypted);
    const auto address = parse_host_port(text.server.substr(question.uses_tls ? kEncrypted.size() : 0));
    if (!address) {
        throw UserError("--health " + text.server + ": write HOST:PORT or https://HOST:PORT");
    }
    question.address = *address;
    question.ca = text.ca;
    question.name = text.name;
    if (question.uses_tls) {
        question.certificate = certificate;
        question.key = key;
    }
    question.token = read_bearer_token(text.token_file, token_of_environment(), "--health-token-file");
    if (!question.token.empty() && !question.uses_tls && !is_loopback(address->host)) {
        throw UserError("--health " + text.server + ": the token would travel unencrypted; write https://");
    }
    return question;
}

} // namespace fieldcast::ops
