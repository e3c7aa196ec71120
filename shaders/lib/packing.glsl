// SPDX-License-Identifier: Apache-2.0
// Compact encodings of G-buffer and illumination values; core/image/packing.h is the CPU side.
#ifndef FIELDCAST_LIB_PACKING
#define FIELDCAST_LIB_PACKING

// Z. Cigolle et al. Survey of Efficient Representations for Independent Unit Vectors. JCGT 3(2), 2014: oct.
vec2 octahedral_wrap(vec2 v) {
    return (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

uint pack_normal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return packSnorm2x16(n.z >= 0.0 ? p : octahedral_wrap(p));
}

vec3 unpack_normal(uint bits) {
    vec2 p = unpackSnorm2x16(bits);
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) {
        n.xy = octahedral_wrap(n.xy);
    }
    return normalize(n);
}

// One unsigned small float with 5 exponent bits and `mantissa_bits`, rounded to nearest; value ≥ 0.
uint pack_unsigned_float(float value, int mantissa_bits) {
    uint half_bits = packHalf2x16(vec2(min(value, 64512.0), 0.0)) & 0x7FFFu; // 5 exponent bits as well
    uint drop = uint(10 - mantissa_bits);
    uint rounded = (half_bits + (1u << (drop - 1u))) >> drop;
    return min(rounded, (30u << mantissa_bits) | ((1u << mantissa_bits) - 1u)); // never infinity
}

uint pack_r11g11b10(vec3 colour) {
    vec3 c = max(colour, vec3(0.0));
    return pack_unsigned_float(c.r, 6) | (pack_unsigned_float(c.g, 6) << 11) | (pack_unsigned_float(c.b, 5) << 22);
}

vec3 unpack_r11g11b10(uint bits) {
    vec2 rg = unpackHalf2x16(((bits & 0x7FFu) << 4) | ((bits & 0x3FF800u) << 9));
    float b = unpackHalf2x16((bits >> 22) << 5).x;
    return vec3(rg, b);
}

uvec2 pack_half3(vec3 colour) {
    vec3 c = min(colour, vec3(65504.0));
    return uvec2(packHalf2x16(c.rg), packHalf2x16(vec2(c.b, 0.0)));
}

vec3 unpack_half3(uvec2 bits) {
    return vec3(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y).x);
}

#endif
