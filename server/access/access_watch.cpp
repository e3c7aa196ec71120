// SPDX-License-Identifier: Apache-2.0
#include "server/access/access_watch.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "server/access/tls_context.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace fieldcast::access {

namespace {

constexpr std::chrono::seconds kInterval{1};
constexpr std::size_t kMaxLoggedLines = 5;

void log_broken_lines(const std::vector<std::string>& problems) {
    for (std::size_t i = 0; i < std::min(problems.size(), kMaxLoggedLines); ++i) {
        log::error("line of the token file ignored", {{"problem", problems[i]}});
    }
    if (problems.size() > kMaxLoggedLines) {
        log::error("further lines of the token file ignored", {{"count", problems.size() - kMaxLoggedLines}});
    }
}

} // namespace

AccessWatch::AccessWatch(const Security& security, Gate& gate, std::function<void()> on_new_tokens)
    : security_(security), gate_(gate), on_new_tokens_(std::move(on_new_tokens)) {
    if (security_.tokens) {
        token_stamp_ = stamp_of(*security_.tokens); // before reading, so that a change in between is noticed later
        TokenList tokens = TokenList::read(*security_.tokens);
        log::info("tokens in use", {{"file", security_.tokens->string()}, {"count", tokens.size()}});
        warn_if_empty(tokens);
        gate_.replace(std::move(tokens));
    }
    if (security_.certificates) {
        certificate_stamps_ = certificate_stamps();
        take_note(check_certificate(*security_.certificates, std::chrono::system_clock::now()));
    }
    if (security_.tokens || security_.certificates) {
        thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
    }
}

void AccessWatch::take_note(const CertificateFacts& facts) {
    *expiry_.lock() = facts.expires;
    log::info("certificate in use", {{"subject", facts.subject}, {"expires", to_text(facts.expires)}});
}

std::vector<FileStamp> AccessWatch::certificate_stamps() const {
    return stamps_of(*security_.certificates);
}

void AccessWatch::watch(const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    while (!never.wait_for(lock, stop, kInterval, [&] { return stop.stop_requested(); })) {
        if (security_.tokens) {
            look_at_tokens();
        }
        if (security_.certificates) {
            look_at_certificates();
        }
    }
}

void AccessWatch::look_at_tokens() {
    const FileStamp stamp = stamp_of(*security_.tokens);
    if (stamp == token_stamp_ && token_problem_.empty()) {
        return;
    }
    const bool is_changed = stamp != token_stamp_;
    token_stamp_ = stamp;
    try {
        std::vector<std::string> problems;
        TokenList tokens = TokenList::read_good_lines(*security_.tokens, problems);
        token_problem_.clear();
        log_broken_lines(problems);
        take_up(std::move(tokens));
    } catch (const std::exception& problem) { // the next check tries again
        if (is_changed || token_problem_ != problem.what()) {
            token_problem_ = problem.what();
            log::error("token file not usable, all calls are denied", {{"problem", token_problem_}});
            take_up({});
        }
    }
}

void AccessWatch::take_up(TokenList tokens) {
    log::info("tokens replaced", {{"file", security_.tokens->string()}, {"count", tokens.size()}});
    warn_if_empty(tokens);
    gate_.replace(std::move(tokens));
    on_new_tokens_();
}

void AccessWatch::warn_if_empty(const TokenList& tokens) const {
    if (tokens.size() == 0) {
        log::warn("token file without tokens, all calls are denied", {{"file", security_.tokens->string()}});
    }
}

void AccessWatch::look_at_certificates() {
    std::vector<FileStamp> stamps = certificate_stamps();
    if (stamps == certificate_stamps_) {
        return;
    }
    certificate_stamps_ = std::move(stamps);
    try {
        take_note(check_certificate(*security_.certificates, std::chrono::system_clock::now()));
    } catch (const std::exception& problem) {
        log::error("certificate not usable", {{"problem", problem.what()}});
    }
}

} // namespace fieldcast::access
