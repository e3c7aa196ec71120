// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/codec/plane_codec.h"

#include <string>
#include <vector>

namespace fieldcast::bench {

/// One way of encoding planes.
struct Coding {
    std::string name; ///< as tables show it
    codec::Encoding encoding{};
    bool uses_key_frame = false; ///< strips may refer to the frame before
    bool uses_base = false;      ///< strips are predicted from the base view
};

/// RAW, ZSTD_FILTERED, the same with key frames, and of each quality JPEG and H264, alone and predicted.
std::vector<Coding> all_codings(const std::vector<std::uint32_t>& qualities);

/// A plane that was encoded and decoded.
struct CodedPlane {
    Plane decoded;
    double bytes = 0.0;     ///< of all strips, headers included
    double encode_ms = 0.0; ///< processor time of one thread
    double decode_ms = 0.0;
};

/// What a plane may be coded from, for codings that use it; null: nothing.
struct Neighbours {
    const Plane* before = nullptr; ///< the same plane of the frame before
    const Plane* base = nullptr;   ///< of the base view
};

/// Encoding a base again is part of the time that prediction takes, as it is for a server. Throws std::logic_error if a
/// lossless coding changed a pixel.
CodedPlane code_plane(const Plane& plane, const Coding& coding, const Neighbours& neighbours, float exposure);

} // namespace fieldcast::bench
