// SPDX-License-Identifier: Apache-2.0
#include "server/access/token.h"

#include "core/base/error.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

namespace fieldcast::access {

namespace {

constexpr std::size_t kSecretBytes = 32;
constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr std::string_view kBase64UrlDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

/// Base64url without padding.
std::string to_base64url(const std::array<std::uint8_t, kSecretBytes>& bytes) {
    std::string text;
    std::uint32_t waiting = 0;
    int waiting_bits = 0;
    for (const std::uint8_t byte : bytes) {
        waiting = (waiting << 8U) | byte;
        waiting_bits += 8;
        while (waiting_bits >= 6) {
            waiting_bits -= 6;
            text += kBase64UrlDigits[(waiting >> waiting_bits) & 0x3FU];
        }
    }
    if (waiting_bits > 0) {
        text += kBase64UrlDigits[(waiting << (6 - waiting_bits)) & 0x3FU];
    }
    return text;
}

std::optional<unsigned> hex_digit(char c) {
    const char lower = c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
    const std::size_t value = kHexDigits.find(lower);
    return value == std::string_view::npos ? std::nullopt : std::optional(static_cast<unsigned>(value));
}

} // namespace

std::string make_token() {
    std::array<std::uint8_t, kSecretBytes> secret{};
    FC_ASSERT(RAND_bytes(secret.data(), static_cast<int>(secret.size())) == 1, "the random generator failed");
    std::string token = "fc_" + to_base64url(secret);
    OPENSSL_cleanse(secret.data(), secret.size());
    return token;
}

TokenHash hash_token(std::string_view token) {
    TokenHash hash{};
    const bool is_ok = EVP_Digest(token.data(), token.size(), hash.data(), nullptr, EVP_sha256(), nullptr) == 1;
    FC_ASSERT(is_ok, "SHA-256 is not available");
    return hash;
}

std::string to_hex(const TokenHash& hash) {
    std::string text;
    for (const std::uint8_t byte : hash) {
        text += kHexDigits[byte >> 4U];
        text += kHexDigits[byte & 0xFU];
    }
    return text;
}

std::optional<TokenHash> parse_hash(std::string_view hex) {
    TokenHash hash{};
    if (hex.size() != 2 * hash.size()) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < hash.size(); ++i) {
        const auto high = hex_digit(hex[2 * i]);
        const auto low = hex_digit(hex[2 * i + 1]);
        if (!high || !low) {
            return std::nullopt;
        }
        hash[i] = static_cast<std::uint8_t>(*high << 4U | *low);
    }
    return hash;
}

bool is_equal(const TokenHash& a, const TokenHash& b) {
    return CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

} // namespace fieldcast::access
