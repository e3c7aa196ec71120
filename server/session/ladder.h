// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/configuration.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::session {

/// One way to send less: how it differs from what the client asked for. 0, false and unset mean no difference.
struct Rung {
    /// The difference from the rung before.
    enum class Step : std::uint8_t { kNone, kCodec, kQuality, kRate, kSize, kGrid, kMode };

    double cost = 1.0; ///< expected bytes per second, relative to what was asked for
    Step step = Step::kNone;
    std::optional<Codec> codec{};   ///< replaces lossless codecs on planes that it can carry
    bool is_scene = false;          ///< delivery mode becomes SCENE
    std::uint8_t quality = 0;       ///< of planes in lossy codecs
    std::uint8_t rate_divisor = 1;  ///< of the frame rate
    std::uint32_t width_px = 0;     ///< of a view, together with the height
    std::uint32_t height_px = 0;
    std::uint32_t rows = 0;         ///< of the grid, together with the columns
    std::uint32_t cols = 0;
};

/// The reductions that `wanted.adaptation` allows on a bad connection, the least visible first: codec, quality, frame
/// rate, size of the views, number of views, delivery mode. Rung 0 is `wanted` itself, which was answered by `granted`;
/// costs fall from rung to rung. Keeps one message and derives the message of a rung from it on demand.
class Ladder {
public:
    Ladder(const v1::Configure& wanted, const Configuration& granted);

    std::span<const Rung> rungs() const { return rungs_; }

    /// The Configure of a client that asks for no more than `rung`.
    v1::Configure configure(const Rung& rung) const;

    /// The difference from the rung before, as text for people.
    std::string change(const Rung& rung) const;

private:
    friend class LadderBuilder;

    v1::Configure wanted_; ///< without adaptation and resume token
    ViewGrid grid_;        ///< spacing and anchor as granted
    float frames_per_second_ = 0.0F;
    std::vector<wire::PlaneChoice> pictures_; ///< planes that lossy codecs can carry, as granted
    std::vector<Rung> rungs_;
};

} // namespace fieldcast::session
