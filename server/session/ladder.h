// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/negotiate.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::session {

/// One way to send less: what differs from what the client asked for. 0 and false: nothing.
struct Rung {
    /// What differs from the rung before.
    enum class Step : std::uint8_t { kNone, kCodec, kQuality, kRate, kSize, kGrid, kMode };

    double cost = 1.0; ///< bytes per second relative to what was asked for; an expectation
    Step step = Step::kNone;
    std::optional<Codec> codec{};   ///< of planes that were lossless and that it can carry
    bool is_scene = false;          ///< mode SCENE
    std::uint8_t quality = 0;       ///< of planes in lossy codecs
    std::uint8_t rate_divisor = 1;  ///< of the frame rate
    std::uint32_t width_px = 0;     ///< of a view, together with the height
    std::uint32_t height_px = 0;
    std::uint32_t rows = 0;         ///< of the grid, together with the columns
    std::uint32_t cols = 0;
};

/// What a server may do about a bad connection, within `wanted.adaptation`, the least painful first: codec, quality,
/// frame rate, size of the views, number of views, delivery mode. Rung 0 is what was asked for and got `granted`; costs
/// fall. Keeps one message, and makes that of a rung when it is asked for.
class Ladder {
public:
    Ladder(const v1::Configure& wanted, const Configuration& granted);

    std::span<const Rung> rungs() const { return rungs_; }

    /// What a client with less to ask for would have sent.
    v1::Configure configure(const Rung& rung) const;

    /// What is different from the rung before, for people.
    std::string change(const Rung& rung) const;

private:
    friend class LadderBuilder;

    v1::Configure wanted_; ///< without what no rung needs
    ViewGrid grid_;        ///< spacing and anchor as granted
    float frames_per_second_ = 0.0F;
    std::vector<wire::PlaneChoice> pictures_; ///< the planes that lossy codecs can carry, as granted
    std::vector<Rung> rungs_;
};

} // namespace fieldcast::session
