// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

namespace fieldcast::scene {

/// Gives every triangle its own three vertices and the normal of its plane. Degenerate triangles get +Z.
void make_flat_normals(Mesh& mesh);

/// Scales normals and tangents to unit length. A zero normal becomes that of the adjacent triangles, or else +Z. A zero
/// tangent becomes an arbitrary vector perpendicular to the normal.
void normalise_frames(Mesh& mesh);

} // namespace fieldcast::scene
