// SPDX-License-Identifier: Apache-2.0
// A scene as the kernels see it. All arrays are uniform texel buffers of descriptor set 0 (RGBA32F texels, integers as
// bit patterns), because texel fetches are the fast path on software Vulkan. The records below are those arrays'
// elements, read by shaders/lib/scene_data.glsl; each is a whole number of 16-byte texels.
#ifndef FIELDCAST_SHARED_SCENE_H
#define FIELDCAST_SHARED_SCENE_H
#include "types.h"

SHARED_BEGIN

// Descriptor set 0.
const uint kBindNodes = 0;            // BVH nodes, see shared/bvh.h
const uint kBindLeafTriangles = 1;    // BVH leaf triangles, see shared/bvh.h
const uint kBindTopLevel = 2;         // placed bottom levels, see shared/bvh.h
const uint kBindInstances = 3;        // InstanceRecord
const uint kBindTriangles = 4;        // RGBA32UI: vertex indices of a triangle (absolute), w unused
const uint kBindVertices = 5;         // VertexRecord
const uint kBindMaterials = 6;        // MaterialRecord
const uint kBindTextureUses = 7;      // TextureUseRecord
const uint kBindLights = 8;           // LightRecord: punctual lights
const uint kBindEmitters = 9;         // EmitterRecord: emissive triangles and their alias table
const uint kBindEnvironmentAlias = 10; // AliasRecord: one per environment texel
const uint kBindSceneInfo = 11;       // SceneInfo, one
const uint kBindEnvironment = 12;     // sampler2DArray with one layer
const uint kBindTextures = 13;        // sampler2DArray[kTextureArrays]
const uint kBindAcceleration = 14;    // top level; only in ray query kernels
const uint kBindGgxAlbedo = 15;       // RGBA32F: directional albedo of GGX, kGgxAlbedoSize² of (A, B): E = F0·A + B

const uint kGgxAlbedoSize = 32; // columns: n·v at (i + 0.5) / size, rows: roughness at i / (size − 1)
const uint kTextureArrays = 8;  // size classes × {sRGB, linear}; unused ones hold one white texel

// Specialisation constants of kernels that look at surfaces; those of the traversal are in shared/bvh.h.
const uint kSpecialiseTextureArrays = 101; // bit k: array k is used by the scene
const uint kSpecialiseBlend = 103;         // bool: some material is BLEND
const uint kSpecialiseMask = 104;          // bool: the drawn triangles have MASK materials

// Light of smoother surfaces depends on the viewer within a grid of views. At this roughness, 75 % of the light that
// GGX reflects is within 15.5°, and views a sixth of that apart see the same.
const float kGlossyRoughness = 0.4f;

const uint kNoIndex = 0xFFFFFFFFu;
const uint kNoInstance = 0xFFFFFFFFu; // visibility: nothing was hit

const uint kAlphaOpaque = 0;
const uint kAlphaMask = 1;
const uint kAlphaBlend = 2;

const uint kMaterialAlphaMask = 3;      // flags & 3: kAlpha…
const uint kMaterialDoubleSided = 4;
const uint kMaterialEmissive = 8;

struct InstanceRecord {
    vec4 world_from_object[3];          // rows
    vec4 previous_world_from_object[3]; // rows, of the frame before
    uint first_triangle;                // in kBindTriangles
    uint material;
    uint first_emitter;                 // emitter of primitive 0, or kNoIndex
    uint flags;                         // kInstance…
};
const uint kInstanceMirrored = 1; // negative determinant: winding is reversed

struct VertexRecord {
    vec3 position;  // object space, metres
    uint normal;    // octahedral snorm 2x16, object space
    vec2 uv0;
    vec2 uv1;
    uint tangent;   // octahedral snorm 2x16, 0xFFFFFFFF: derive from uv
    uint colour;    // RGBA8, linear
    float tangent_sign;
    uint unused;
};

struct MaterialRecord {
    vec4 base_colour;  // factor
    vec3 emission;     // factor × strength, W / (m² sr)
    float alpha_cutoff;
    float metallic;
    float roughness;
    float normal_scale;
    float ior;
    float transmission;
    uint flags;        // kMaterial…
    uint base_colour_use; // index into kBindTextureUses, or kNoIndex
    uint metallic_roughness_use;
    uint normal_use;
    uint emission_use;
    uint transmission_use;
    uint unused;
};

struct TextureUseRecord {
    vec3 u_row;     // u' = dot(u_row, (u, v, 1))
    uint place;     // array | layer << 4 | wrap_u << 20 | wrap_v << 22 | uv set << 24
    vec3 v_row;
    float size_px;  // geometric mean of width and height, for the level of detail
};

struct LightRecord {
    vec3 position;       // world space, metres (not directional)
    uint type;           // kLight…
    vec3 direction;      // towards which it shines, unit
    float range_m;       // 0: unlimited
    vec3 intensity;      // W/m² at normal incidence (directional), W/sr
    float probability;   // of being chosen among the punctual lights
    float cos_inner;
    float cos_outer;
    float cos_radius;    // of the disc of a directional light; 1: a delta direction
    uint unused;
};
const uint kLightDirectional = 0;
const uint kLightPoint = 1;
const uint kLightSpot = 2;

struct EmitterRecord {
    float accept;        // alias table: keep this emitter if u < accept
    uint alias;          // else take this one
    uint instance;
    uint primitive;
    float probability;   // of being chosen among the emitters
    float area_m2;       // world space, at load time
    uint unused0;
    uint unused1;
};

struct AliasRecord {
    float accept;
    uint alias;
    float probability; // of this texel
    uint unused;
};

struct SceneInfo {
    vec3 sky;                      // constant environment
    uint environment_width;        // 0: constant sky
    uint environment_height;
    uint light_count;
    uint emitter_count;
    uint instance_count;
    float probability_environment; // of next event estimation choosing …; the three add up to 1 (or all 0)
    float probability_emitter;
    float probability_light;
    uint has_blend;                // some material is BLEND
    vec3 centre;                   // bounding sphere
    float radius_m;
};

SHARED_END
#endif
