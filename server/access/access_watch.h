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

/// What a server is protected by.
struct Security {
    std::optional<CertificateFiles> certificates; ///< unset: plain text
    std::optional<std::filesystem::path> tokens;  ///< unset: everybody may do everything
    bool accepts_known_attacks = false;           ///< on gRPC itself, see exposure_problem()
};

/// Follows changes of the token file and the certificates once a second, in a thread of its own. Tokens fail closed: a
/// token file that is missing, unreadable or empty means that nobody may call, and a line with a mistake counts for
/// nobody. Certificates that have become unusable are reported, and what was read before stays in force.
class AccessWatch {
public:
    /// Reads the tokens into `gate`, which must outlive this. `on_new_tokens` is called after each later change. Throws
    /// UserError if a file is not usable now; here, a broken line is enough.
    AccessWatch(const Security& security, Gate& gate, std::function<void()> on_new_tokens);

    /// When the certificate in use expires, if there is one.
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
    std::string token_problem_; ///< why the file cannot be used; empty: it can
    std::vector<FileStamp> certificate_stamps_;
    mutable Guarded<std::optional<std::chrono::system_clock::time_point>> expiry_;
    std::jthread thread_;
};

} // namespace fieldcast::access
