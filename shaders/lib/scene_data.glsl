// SPDX-License-Identifier: Apache-2.0
// Descriptor set 0 and the loads of its records (shared/scene.h).
#ifndef FIELDCAST_LIB_SCENE_DATA
#define FIELDCAST_LIB_SCENE_DATA
#include "shared/scene.h"

layout(set = 0, binding = kBindInstances) uniform samplerBuffer instances_;
layout(set = 0, binding = kBindTriangles) uniform usamplerBuffer triangles_;
layout(set = 0, binding = kBindVertices) uniform samplerBuffer vertices_;
layout(set = 0, binding = kBindMaterials) uniform samplerBuffer materials_;
layout(set = 0, binding = kBindTextureUses) uniform samplerBuffer texture_uses_;
layout(set = 0, binding = kBindLights) uniform samplerBuffer lights_;
layout(set = 0, binding = kBindEmitters) uniform samplerBuffer emitters_;
layout(set = 0, binding = kBindEnvironmentAlias) uniform samplerBuffer environment_alias_;
layout(set = 0, binding = kBindSceneInfo) uniform samplerBuffer scene_info_;
layout(set = 0, binding = kBindEnvironment) uniform sampler2DArray environment_;
layout(set = 0, binding = kBindTextures) uniform sampler2DArray textures_[kTextureArrays];
layout(set = 0, binding = kBindGgxAlbedo) uniform samplerBuffer ggx_albedo_;

// Bit k: texture array k is used by the scene. Unused ones cost nothing.
layout(constant_id = kSpecialiseTextureArrays) const uint kUsedTextureArrays = 0xFFu;

struct Placement {
    mat4x3 world_from_object;
    uint first_triangle;
    uint material;
    uint first_emitter;
    uint flags;
};

mat4x3 rows_to_matrix(vec4 r0, vec4 r1, vec4 r2) {
    return mat4x3(r0.x, r1.x, r2.x, r0.y, r1.y, r2.y, r0.z, r1.z, r2.z, r0.w, r1.w, r2.w);
}

Placement load_placement(uint instance) {
    int base = int(instance) * 7;
    uvec4 tail = floatBitsToUint(texelFetch(instances_, base + 6));
    mat4x3 world_from_object = rows_to_matrix(texelFetch(instances_, base), texelFetch(instances_, base + 1),
                                              texelFetch(instances_, base + 2));
    return Placement(world_from_object, tail.x, tail.y, tail.z, tail.w);
}

mat4x3 load_previous_transform(uint instance) {
    int base = int(instance) * 7 + 3;
    return rows_to_matrix(texelFetch(instances_, base), texelFetch(instances_, base + 1),
                          texelFetch(instances_, base + 2));
}

uvec4 load_placement_tail(uint instance) {
    return floatBitsToUint(texelFetch(instances_, int(instance) * 7 + 6));
}

uvec3 load_triangle(uint triangle) {
    return texelFetch(triangles_, int(triangle)).xyz;
}

vec4 load_vertex(uint vertex) { // position, packed normal
    return texelFetch(vertices_, int(vertex) * 3);
}

vec4 load_vertex_uv(uint vertex) { // uv0, uv1
    return texelFetch(vertices_, int(vertex) * 3 + 1);
}

vec4 load_vertex_extra(uint vertex) { // tangent bits, colour bits, tangent sign
    return texelFetch(vertices_, int(vertex) * 3 + 2);
}

MaterialRecord load_material(uint material) {
    int base = int(material) * 5;
    vec4 a = texelFetch(materials_, base);
    vec4 b = texelFetch(materials_, base + 1);
    vec4 c = texelFetch(materials_, base + 2);
    vec4 d = texelFetch(materials_, base + 3);
    uvec4 e = floatBitsToUint(texelFetch(materials_, base + 4));
    MaterialRecord m;
    m.base_colour = a;
    m.emission = b.xyz;
    m.alpha_cutoff = b.w;
    m.metallic = c.x;
    m.roughness = c.y;
    m.normal_scale = c.z;
    m.ior = c.w;
    m.transmission = d.x;
    m.flags = floatBitsToUint(d.y);
    m.base_colour_use = floatBitsToUint(d.z);
    m.metallic_roughness_use = floatBitsToUint(d.w);
    m.normal_use = e.x;
    m.emission_use = e.y;
    m.transmission_use = e.z;
    m.unused = e.w;
    return m;
}

uint texture_use_set(uint use) { // 0 or 1
    return floatBitsToUint(texelFetch(texture_uses_, int(use) * 2).w) >> 24;
}

float wrap_coordinate(float u, uint mode, float half_texel) {
    float repeated = fract(u);
    float mirrored = 1.0 - abs(1.0 - 2.0 * fract(0.5 * u));
    float inside = mode == 1u ? mirrored : u;
    return mode == 0u ? repeated : clamp(inside, half_texel, 1.0 - half_texel);
}

#define SAMPLE_ARRAY(k)                                                                                                \
    if ((kUsedTextureArrays & (1u << k)) != 0u && array == k) {                                                        \
        result = textureLod(textures_[k], vec3(wrapped, layer), lod);                                                  \
    }

// Samples one use of a texture. `lod_offset` = log2 of uv units per pixel footprint; texture size is added here.
vec4 sample_texture(uint use, vec4 uv01, float lod_offset) {
    vec4 a = texelFetch(texture_uses_, int(use) * 2);
    vec4 b = texelFetch(texture_uses_, int(use) * 2 + 1);
    uint place = floatBitsToUint(a.w);
    vec3 uv = vec3((place >> 24) == 0u ? uv01.xy : uv01.zw, 1.0);
    uint array = place & 15u;
    float layer = float((place >> 4) & 0xFFFFu);
    float scale = abs(a.x * b.y - a.y * b.x); // texels per uv area change of KHR_texture_transform
    float lod = max(0.0, lod_offset + log2(b.w * sqrt(max(scale, 1e-12))));
    float half_texel = min(0.5, 0.5 * exp2(ceil(lod)) / b.w); // of the coarser level that is filtered
    vec2 wrapped = vec2(wrap_coordinate(dot(a.xyz, uv), (place >> 20) & 3u, half_texel),
                        wrap_coordinate(dot(b.xyz, uv), (place >> 22) & 3u, half_texel));
    vec4 result = vec4(1.0);
    SAMPLE_ARRAY(0u)
    SAMPLE_ARRAY(1u)
    SAMPLE_ARRAY(2u)
    SAMPLE_ARRAY(3u)
    SAMPLE_ARRAY(4u)
    SAMPLE_ARRAY(5u)
    SAMPLE_ARRAY(6u)
    SAMPLE_ARRAY(7u)
    return result;
}

#endif
