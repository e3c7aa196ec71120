// SPDX-License-Identifier: Apache-2.0
// Storage format of the light of holes.
#ifndef FIELDCAST_LIB_HOLE_LIGHT
#define FIELDCAST_LIB_HOLE_LIGHT

// Illumination of a hole, and the number of frames that were averaged.
struct HoleLight {
    vec3 diffuse;
    vec3 specular;
    float frames;
};

const float kMaxHalf = 65504.0;

uvec4 pack_hole_light(HoleLight light) {
    vec3 d = min(light.diffuse, vec3(kMaxHalf));
    vec3 s = min(light.specular, vec3(kMaxHalf));
    return uvec4(packHalf2x16(d.rg), packHalf2x16(vec2(d.b, light.frames)), packHalf2x16(s.rg),
                 packHalf2x16(vec2(s.b, 0.0)));
}

HoleLight unpack_hole_light(uvec4 bits) {
    vec2 blue_frames = unpackHalf2x16(bits.y);
    return HoleLight(vec3(unpackHalf2x16(bits.x), blue_frames.x), vec3(unpackHalf2x16(bits.z), unpackHalf2x16(bits.w).x),
                     blue_frames.y);
}

#endif
