// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/health_flags.h"

#include "core/base/bearer_token.h"
#include "core/base/error.h"

#include <CLI/CLI.hpp>

namespace fieldcast::command_line {

void add_health_flags(CLI::App& app, HealthText& text) {
    const auto add = [&](const char* flag, std::string& value, const char* help) {
        app.add_option(flag, value, help)->group("Probing another server")->configurable(false);
    };
    add("--health", text.server,
        "HOST:PORT or https://HOST:PORT: ask this server for its health and exit with 0 if it is SERVING, else with "
        "1.");
    add("--health-ca", text.ca, "PEM file with the authorities of its certificate; default: those of the system.");
    add("--health-name", text.name, "Name in its certificate, if it differs from HOST.");
    add("--health-token-file", text.token_file, "File with the token to present; default: FIELDCAST_TOKEN.");
}

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

} // namespace fieldcast::command_line
