// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/codec/plane_codec.h"

#include <string>
#include <vector>

namespace fieldcast::bench {

/// One way of encoding planes.
struct Coding {
    std::string name; ///< name in tables
    codec::Encoding encoding{};
    bool uses_key_frame = false; ///< strips may refer to the previous frame
    bool uses_base = false;      ///< strips are predicted from the base view
};

/// RAW, ZSTD_FILTERED, ZSTD_FILTERED with key frames, and JPEG and H264 at each quality, with and without prediction.
std::vector<Coding> all_codings(const std::vector<std::uint32_t>& qualities);

/// The result of encoding and decoding a plane.
struct CodedPlane {
    Plane decoded;
    double bytes = 0.0;     ///< of all strips, headers included
    double encode_ms = 0.0; ///< CPU time of one thread
    double decode_ms = 0.0;
};

/// Reference planes for codings that use them; null: none.
struct Neighbours {
    const Plane* before = nullptr; ///< the same plane of the previous frame
    const Plane* base = nullptr;   ///< of the base view
};

/// Encodes and decodes a plane. The time of prediction includes encoding the base again, as on a server. Throws
/// std::logic_error if a lossless coding changed a pixel.
CodedPlane code_plane(const Plane& plane, const Coding& coding, const Neighbours& neighbours, float exposure);

} // namespace fieldcast::bench
