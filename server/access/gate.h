// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/access/token_list.h"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace fieldcast::access {

/// Reason for denying a call.
struct Denial {
    enum class Kind : std::uint8_t {
        kNoToken,      ///< no token, or not sent as "Bearer TOKEN"
        kUnknownToken, ///< not in the list
        kRoleTooLow,
    };
    Kind kind = Kind::kNoToken;
    std::string message; ///< for the caller; contains nothing that it sent
};

/// Decides which callers may call which methods. Thread-safe.
class Gate {
public:
    /// Without tokens every caller has the role admin; such a server listens on loopback only.
    Gate() = default;
    explicit Gate(TokenList tokens) { replace(std::move(tokens)); }

    bool asks_for_tokens() const;

    /// The caller's identity, or why the call is denied. `authorization` is the value of the header, "Bearer TOKEN";
    /// `method` is the full name of a gRPC method.
    tl::expected<Identity, Denial> admit(std::optional<std::string_view> authorization, std::string_view method) const;

    /// The same for anything else than a gRPC method.
    tl::expected<Identity, Denial> admit(std::optional<std::string_view> authorization, std::string_view what,
                                         Role needed) const;

    /// Whether the token of an admitted identity is still in the list.
    bool is_valid(const Identity& identity) const;

    /// Replaces the list of tokens.
    void replace(TokenList tokens);

private:
    std::shared_ptr<const TokenList> tokens() const { return *tokens_.lock(); }

    mutable Guarded<std::shared_ptr<const TokenList>> tokens_; ///< null: no token is required
};

} // namespace fieldcast::access
