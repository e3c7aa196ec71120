// SPDX-License-Identifier: Apache-2.0
#include "server/access/access_watch.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "server/access/tls_context.h"

#include <condition_variable>
#include <mutex>

namespace fieldcast::access {

namespace {

constexpr std::chrono::seconds kInterval{1};

} // namespace

AccessWatch::AccessWatch(const Security& security, Gate& gate, std::function<void()> on_new_tokens)
    : security_(security), gate_(gate), on_new_tokens_(std::move(on_new_tokens)) {
    if (security_.tokens) {
        token_stamp_ = stamp_of(*security_.tokens); // before reading: a change in between is seen again
        TokenList tokens = TokenList::read(*security_.tokens);
        log::info("tokens in use", {{"file", security_.tokens->string()}, {"count", tokens.size()}});
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
    if (stamp == token_stamp_) {
        return;
    }
    token_stamp_ = stamp;
    try {
        TokenList tokens = TokenList::read(*security_.tokens);
        log::info("tokens replaced", {{"file", security_.tokens->string()}, {"count", tokens.size()}});
        gate_.replace(std::move(tokens));
        on_new_tokens_();
    } catch (const std::exception& problem) {
        log::error("tokens not replaced, the earlier ones stay in force", {{"problem", problem.what()}});
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
