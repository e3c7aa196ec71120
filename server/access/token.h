// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fieldcast::access {

/// SHA-256 of a token. Tokens have 256 random bits, so the hash cannot be inverted by search and needs neither salt nor
/// stretching.
using TokenHash = std::array<std::uint8_t, 32>;

/// A new secret: "fc_" and 43 characters of base64url (RFC 4648, section 5), 256 bits from the system's random
/// generator.
std::string make_token();

TokenHash hash_token(std::string_view token);

std::string to_hex(const TokenHash& hash);
std::optional<TokenHash> parse_hash(std::string_view hex); ///< `hex`: 64 hexadecimal digits

/// Compares in a time that does not depend on the position of a difference.
bool is_equal(const TokenHash& a, const TokenHash& b);

} // namespace fieldcast::access
