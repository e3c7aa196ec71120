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

/// Why a caller may not do what it asked for.
struct Denial {
    enum class Kind : std::uint8_t {
        kNoToken,      ///< none, or not as "Bearer TOKEN"
        kUnknownToken, ///< not in the list
        kRoleTooLow,
    };
    Kind kind = Kind::kNoToken;
    std::string message; ///< for the caller; holds nothing of what it sent
};

/// Decides who may call what. Thread-safe.
class Gate {
public:
    /// Everybody may do everything: without tokens a server listens on loopback only.
    Gate() = default;
    explicit Gate(TokenList tokens) { replace(std::move(tokens)); }

    bool asks_for_tokens() const;

    /// `authorization` is the header's value, "Bearer TOKEN"; `method` the full name of a gRPC method.
    tl::expected<Identity, Denial> admit(std::optional<std::string_view> authorization, std::string_view method) const;

    /// As `admit`, for anything that is no gRPC method.
    tl::expected<Identity, Denial> admit(std::optional<std::string_view> authorization, std::string_view what,
                                         Role needed) const;

    /// Whether an identity that was once admitted still stands in the list.
    bool is_valid(const Identity& identity) const;

    /// From now on these tokens count.
    void replace(TokenList tokens);

private:
    std::shared_ptr<const TokenList> tokens() const { return *tokens_.lock(); }

    mutable Guarded<std::shared_ptr<const TokenList>> tokens_; ///< null: nobody is asked
};

} // namespace fieldcast::access
