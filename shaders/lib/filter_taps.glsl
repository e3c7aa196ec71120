// SPDX-License-Identifier: Apache-2.0
// Inputs and SVGF's edge-stopping weights, which filters over the source share. The including kernel has `params` with
// cameras, source_count, width, height, sigma_depth and normal_squarings as in FilterParams.
// Follows: C. Schied et al. Spatiotemporal Variance-Guided Filtering. HPG 2017, section 4.4, equations 3 to 5.
// Differs: the depth term compares with the plane through the centre pixel's neighbourhood by its depth gradient, made
// from the normal instead of screen space derivatives, which a ray traced G-buffer does not have.
#ifndef FIELDCAST_LIB_FILTER_TAPS
#define FIELDCAST_LIB_FILTER_TAPS
#include "lib/camera.glsl"
#include "lib/lobe.glsl"
#include "lib/packing.glsl"
#include "lib/pages.glsl"

layout(set = 0, binding = kFilterGeometry) uniform usamplerBuffer geometry_;
layout(set = 0, binding = kFilterDiffuse) uniform samplerBuffer diffuse_;
layout(set = 0, binding = kFilterSpecular) uniform samplerBuffer specular_;
layout(set = 0, binding = kFilterMoments) uniform samplerBuffer moments_;
layout(set = 0, binding = kFilterLength) uniform samplerBuffer length_;

float luminance(vec3 c) {
    return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

struct Centre {
    ivec2 at;
    int page_start;      // texel of the page's first pixel
    float depth;
    vec2 depth_gradient; // per pixel
    vec3 normal;
    uint id;
    float lobe_falloff;  // of specular weights, per squared angle; 0: like diffuse ones
    float pixel_angle;   // between neighbouring pixels' rays
};

// Change of depth per pixel across the image, of a plane through the surface point.
vec2 depth_gradient(CameraRecord camera, ivec2 at, float depth, vec3 normal) {
    vec3 ray = camera_direction(camera, vec2(at) + 0.5);
    float along = dot(normal, ray);
    along = abs(along) < 0.05 ? (along < 0.0 ? -0.05 : 0.05) : along;
    return vec2(-dot(normal, camera.right), dot(normal, camera.up)) * (depth / (along * camera.focal_px));
}

Centre load_centre(uint index, uvec4 geometry) {
    PagePixel pixel = locate_page_pixel(index, params.width, params.height);
    Centre c;
    c.at = ivec2(pixel.x, pixel.y);
    c.page_start = int(pixel.page * params.width * params.height);
    c.depth = uintBitsToFloat(geometry.x);
    c.normal = unpack_normal(geometry.y);
    c.id = geometry.z;
    CameraRecord camera = params.cameras.at[source_of_page(pixel.page, params.source_count)];
    c.depth_gradient = depth_gradient(camera, c.at, c.depth, c.normal);
    c.pixel_angle = 1.0 / camera.focal_px;
    c.lobe_falloff = lobe_falloff(float(geometry.w & 255u) / 255.0, c.pixel_angle);
    return c;
}

// Similarity of the lobes that two pixels' surfaces reflect: a mirror's lobe turns twice as far as its normal.
float lobe_similarity(Centre c, ivec2 offset, uvec4 geometry) {
    float turned = 8.0 * max(0.0, 1.0 - dot(c.normal, unpack_normal(geometry.y)));
    float apart = dot(vec2(offset), vec2(offset)) * c.pixel_angle * c.pixel_angle;
    return exp(-(turned + apart) * c.lobe_falloff);
}

// Weight of a tap from geometry alone; 0 for other instances, materials and sky.
float geometry_weight(Centre c, ivec2 offset, uvec4 geometry) {
    float expected = c.depth + dot(c.depth_gradient, vec2(offset));
    float tolerance = params.sigma_depth * (dot(abs(c.depth_gradient), abs(vec2(offset))) + 1e-3 * c.depth);
    float off_plane = abs(uintBitsToFloat(geometry.x) - expected) / max(tolerance, 1e-12);
    float cos_normals = max(dot(c.normal, unpack_normal(geometry.y)), 0.0);
    for (uint i = 0u; i < params.normal_squarings; ++i) {
        cos_normals *= cos_normals; // cos^σ with σ = 2^normal_squarings: pow() costs several times as much
    }
    return geometry.z == c.id ? exp(-off_plane) * cos_normals : 0.0;
}

int tap_texel(Centre c, ivec2 at) {
    return c.page_start + at.y * int(params.width) + at.x;
}

bool is_inside(ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && at.x < int(params.width) && at.y < int(params.height);
}

#endif
