// SPDX-License-Identifier: Apache-2.0
#include "server/session/field_limits.h"

#include <algorithm>
#include <array>

namespace fieldcast::session {

namespace {

using Configure = v1::Configure;
using Preference = v1::CodecPreference;

/// The largest `size` of all codec preferences in `wanted`.
template <class Size> std::size_t largest(const Configure& wanted, const Size& size) {
    std::size_t most = 0;
    for (const Preference& preference : wanted.codecs()) {
        most = std::max(most, static_cast<std::size_t>(size(preference)));
    }
    return most;
}

// Newer clients may name modes, codecs, formats and planes that this server does not know and passes over: the counts
// leave room for them.
constexpr std::array kFieldLimits{
    FieldLimit{"channel", feed::kMaxChannelNameBytes, "bytes", [](const Configure& m) { return m.channel().size(); }},
    FieldLimit{"resume_token", 256, "bytes", [](const Configure& m) { return m.resume_token().size(); }},
    FieldLimit{"modes", 8, "entries", [](const Configure& m) { return std::size_t(m.modes_size()); }},
    FieldLimit{"warp_planes", 16, "entries", [](const Configure& m) { return std::size_t(m.warp_planes_size()); }},
    FieldLimit{"codecs", 32, "entries", [](const Configure& m) { return std::size_t(m.codecs_size()); }},
    FieldLimit{"codecs.codecs", 16, "entries",
               [](const Configure& m) { return largest(m, [](const Preference& p) { return p.codecs_size(); }); }},
    FieldLimit{"codecs.formats", 16, "entries",
               [](const Configure& m) { return largest(m, [](const Preference& p) { return p.formats_size(); }); }},
    FieldLimit{"adaptation.codecs", 16, "entries",
               [](const Configure& m) { return std::size_t(m.adaptation().codecs_size()); }},
    FieldLimit{"adaptation.modes", 8, "entries",
               [](const Configure& m) { return std::size_t(m.adaptation().modes_size()); }},
};

} // namespace

std::span<const FieldLimit> field_limits() {
    return kFieldLimits;
}

std::optional<Refusal> oversized_field(const v1::Configure& wanted) {
    for (const FieldLimit& limit : kFieldLimits) {
        const std::size_t size = limit.size(wanted);
        if (size > limit.most) {
            return Refusal{.reason = v1::REFUSAL_REASON_INVALID,
                           .field = std::string(limit.field),
                           .message = std::to_string(size) + " " + std::string(limit.unit) + " sent, at most " +
                                      std::to_string(limit.most) + " allowed"};
        }
    }
    return std::nullopt;
}

} // namespace fieldcast::session
