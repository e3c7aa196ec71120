// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <tl/expected.hpp>

namespace fieldcast {

/// The user's input is wrong. The message names the place and the problem
/// ("garden.gltf: node 12 'lamp': light has no intensity"). Programs exit with code 2.
class UserError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Reason why untrusted bytes could not be decoded.
struct DecodeError {
    std::string message; ///< names the field and the limit
};

/// Result of decoding untrusted bytes. Decoders never throw and never allocate more than their stated limits.
template <class T> using Decoded = tl::expected<T, DecodeError>;

inline tl::unexpected<DecodeError> decode_error(std::string message) {
    return tl::unexpected(DecodeError{std::move(message)});
}

/// Throws std::logic_error that names file and line. It means that Fieldcast has a bug.
[[noreturn]] void assertion_failed(const char* condition, const char* message, const char* file, int line);

} // namespace fieldcast

/// Checks an invariant of Fieldcast's own code, in every build type.
#define FC_ASSERT(condition, message)                                                                                  \
    ((condition) ? static_cast<void>(0) : ::fieldcast::assertion_failed(#condition, message, __FILE__, __LINE__))
