// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/certificate.h"
#include "server/access/gate.h"
#include "server/access/text_file.h"

#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace fieldcast::access {

/// Protection of a server: files of certificates and tokens.
struct Security {
    std::optional<CertificateFiles> certificates; ///< unset: no TLS
    std::optional<std::filesystem::path> tokens;  ///< unset: every caller has the role admin
    bool accepts_known_attacks = false;           ///< allows a gRPC with known attacks, see exposure_problem()
};

/// Checks the token file and the certificates for changes once a second, in a thread of its own. Tokens fail closed:
/// all calls are denied while the token file is missing, unreadable or empty, and a line with a mistake is ignored. If
/// certificates become unusable, that is logged and the previous ones stay in use.
class AccessWatch {
public:
    /// Reads the tokens into `gate`, which must outlive this. Calls `on_new_tokens` after each later change. Throws
    /// UserError if a file is not usable or one line of the token file has a mistake.
    AccessWatch(const Security& security, Gate& gate, std::function<void()> on_new_tokens);

    /// Expiry of the certificate in use, if there is one.
    std::optional<std::chrono::system_clock::time_point> certificate_expiry() const { return *expiry_.lock(); }

private:
    void take_note(const CertificateFacts& facts);
    std::vector<FileStamp> certificate_stamps() const;
    void watch(const std::stop_token& stop);
    void look_at_tokens();
    void take_up(TokenList tokens);
    void warn_if_empty(const TokenList& tokens) const;
    void look_at_certificates();

    Security security_;
    Gate& gate_;
    std::function<void()> on_new_tokens_;
    FileStamp token_stamp_;
    std::string token_problem_; ///< why the token file is not usable; empty: it is
    std::vector<FileStamp> certificate_stamps_;
    mutable Guarded<std::optional<std::chrono::system_clock::time_point>> expiry_;
    std::jthread thread_;
};

} // namespace fieldcast::access
