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
};

/// RAW, ZSTD_FILTERED, the same with key frames, and JPEG of each quality.
std::vector<Coding> all_codings(const std::vector<std::uint32_t>& qualities);

/// A plane that was encoded and decoded.
struct CodedPlane {
    Plane decoded;
    double bytes = 0.0;     ///< of all strips, headers included
    double encode_ms = 0.0; ///< processor time of one thread
    double decode_ms = 0.0;
};

/// `reference`: the same plane of the frame before, for codings that use it; null: none. Throws std::logic_error if a
/// lossless coding changed a pixel.
CodedPlane code_plane(const Plane& plane, const Coding& coding, const Plane* reference, float exposure);

} // namespace fieldcast::bench
