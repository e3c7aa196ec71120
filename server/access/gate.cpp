// SPDX-License-Identifier: Apache-2.0
#include "server/access/gate.h"

#include <cctype>

namespace fieldcast::access {

namespace {

constexpr std::size_t kMaxTokenBytes = 512; // our tokens have 46; longer ones are not hashed

/// The token in "Bearer TOKEN" (RFC 6750, section 2.1). The case of the scheme is ignored (RFC 9110, section 11.1).
std::optional<std::string_view> token_in(std::optional<std::string_view> authorization) {
    constexpr std::string_view kScheme = "bearer ";
    if (!authorization || authorization->size() <= kScheme.size() || authorization->size() > kMaxTokenBytes) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < kScheme.size(); ++i) {
        if (std::tolower(static_cast<unsigned char>((*authorization)[i])) != kScheme[i]) {
            return std::nullopt;
        }
    }
    return authorization->substr(kScheme.size());
}

tl::unexpected<Denial> deny(Denial::Kind kind, std::string message) {
    return tl::unexpected(Denial{.kind = kind, .message = std::move(message)});
}

} // namespace

bool Gate::asks_for_tokens() const {
    return tokens() != nullptr;
}

tl::expected<Identity, Denial> Gate::admit(std::optional<std::string_view> authorization,
                                           std::string_view method) const {
    return admit(authorization, method, needed_role(method));
}

tl::expected<Identity, Denial> Gate::admit(std::optional<std::string_view> authorization, std::string_view what,
                                           Role needed) const {
    const auto tokens = this->tokens();
    if (tokens == nullptr) {
        return Identity{.name = "", .role = Role::kAdmin, .hash = {}};
    }
    const auto token = token_in(authorization);
    if (!token) {
        return deny(Denial::Kind::kNoToken, "this server requires a token: send the header 'authorization: Bearer "
                                            "TOKEN' (fieldcast-client: --token-file FILE or FIELDCAST_TOKEN)");
    }
    auto identity = tokens->find(*token);
    if (!identity) {
        return deny(Denial::Kind::kUnknownToken,
                    "unknown token: it is mistyped, for another server, or revoked");
    }
    if (identity->role < needed) {
        return deny(Denial::Kind::kRoleTooLow, "the token of '" + identity->name + "' has the role " +
                                                   std::string(to_text(identity->role)) + "; " + std::string(what) +
                                                   " needs " + std::string(to_text(needed)));
    }
    return *identity;
}

bool Gate::is_valid(const Identity& identity) const {
    const auto tokens = this->tokens();
    return tokens == nullptr || tokens->contains(identity);
}

void Gate::replace(TokenList tokens) {
    auto next = std::make_shared<const TokenList>(std::move(tokens));
    *tokens_.lock() = std::move(next);
}

} // namespace fieldcast::access
