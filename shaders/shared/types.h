// SPDX-License-Identifier: Apache-2.0
// The one bridge between C++ and GLSL: structs written once, with scalar layout on both sides.
//
//   #ifndef FIELDCAST_SHARED_RAYS_H // GLSL has no `#pragma once`
//   #define FIELDCAST_SHARED_RAYS_H
//   #include "types.h"              // next to the including header, so both compilers find it
//   SHARED_BEGIN
//   struct Ray {
//       vec3 origin;
//       float t_max;
//   };
//   SHARED_BUFFER(RayBuffer, Ray); // GLSL: rays.at[i]; C++: a 64-bit device address
//   struct RayParams {
//       RayBuffer rays;
//       uint ray_count;
//   };
//   SHARED_END
//   #endif
//
// Members: float, int, uint, uint64_t, {,i,u}vec2..4, mat3, mat4, buffers, other shared structs, arrays of these.
// Constants: `const uint kName = 3u;`. tests/gpu compares the offsets of both sides.
#ifndef FIELDCAST_SHARED_TYPES_H
#define FIELDCAST_SHARED_TYPES_H

#ifdef __cplusplus

#include <cstdint>
#include <glm/glm.hpp>

namespace fieldcast::shared {

using std::uint64_t;
using uint = std::uint32_t;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

static_assert(alignof(vec4) == 4 && sizeof(vec3) == 12 && sizeof(mat3) == 36, "glm must not align its types");
static_assert(alignof(uint64_t) == 8, "device addresses are aligned as in scalar layout");

} // namespace fieldcast::shared

#define SHARED_BEGIN namespace fieldcast::shared {
#define SHARED_END }
#define SHARED_BUFFER(Name, Element) using Name = std::uint64_t

#else

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#define SHARED_BEGIN
#define SHARED_END
// A buffer starts at a multiple of 16 bytes; `Name(address + offset)` keeps to that too. Drivers of GPUs may then use
// 128-bit loads; software Vulkan is as fast with 4 (measured: 8 vec4 loads per thread, Mesa 22.3.6 and 25.0.7).
#define SHARED_BUFFER(Name, Element)                                                                                   \
    layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Name { Element at[]; }

#endif

// Arrays of plain values.
SHARED_BEGIN
SHARED_BUFFER(FloatBuffer, float);
SHARED_BUFFER(UintBuffer, uint);
SHARED_BUFFER(Uvec2Buffer, uvec2);
SHARED_BUFFER(Uvec4Buffer, uvec4);
SHARED_BUFFER(Vec2Buffer, vec2);
SHARED_BUFFER(Vec3Buffer, vec3);
SHARED_BUFFER(Vec4Buffer, vec4);
SHARED_BUFFER(Mat4Buffer, mat4);
SHARED_END

#endif
