// SPDX-License-Identifier: Apache-2.0
// Computes everything that shading needs from (instance, primitive). This is the only place where surface attributes
// are computed, so that visibility may come from rays, a rasteriser or reprojection.
#ifndef FIELDCAST_LIB_SURFACE
#define FIELDCAST_LIB_SURFACE
#include "lib/packing.glsl"
#include "lib/scene_data.glsl"

// A triangle placed in the world.
struct WorldTriangle {
    uint instance;
    uint primitive;
    uvec3 vertices;
    vec3 p0;
    vec3 edge1;
    vec3 edge2;
    uvec3 normals; // packed, object space
    mat4x3 world_from_object;
    uint material;
    uint first_emitter;
    bool is_mirrored;
};

struct Surface {
    vec3 position;
    vec3 geometric_normal; // unit, on the viewer's side
    vec3 normal;           // shading normal, unit, on the viewer's side
    vec3 diffuse_colour;   // base colour × (1 − metallic)
    vec3 f0;               // reflectance at normal incidence
    float f90;             // at grazing incidence: 1, but less for indices of refraction near 1
    vec3 transmission;     // thin wall: colour × factor × (1 − metallic)
    vec3 emission;         // towards the viewer, W / (m² sr)
    float roughness;       // perceptual; GGX α = roughness²
    float metallic;
    float alpha;           // coverage of BLEND materials, else 1
    float area_m2;         // of the triangle
    uint material;
    uint emitter;          // index into emitters, or kNoIndex
};

WorldTriangle load_world_triangle(uint instance, uint primitive) {
    WorldTriangle t;
    Placement placement = load_placement(instance);
    t.instance = instance;
    t.primitive = primitive;
    t.world_from_object = placement.world_from_object;
    t.material = placement.material;
    t.first_emitter = placement.first_emitter;
    t.is_mirrored = (placement.flags & kInstanceMirrored) != 0u;
    t.vertices = load_triangle(placement.first_triangle + primitive);
    vec4 v0 = load_vertex(t.vertices.x);
    vec4 v1 = load_vertex(t.vertices.y);
    vec4 v2 = load_vertex(t.vertices.z);
    t.p0 = t.world_from_object * vec4(v0.xyz, 1.0);
    t.edge1 = t.world_from_object * vec4(v1.xyz - v0.xyz, 0.0);
    t.edge2 = t.world_from_object * vec4(v2.xyz - v0.xyz, 0.0);
    t.normals = floatBitsToUint(vec3(v0.w, v1.w, v2.w));
    return t;
}

// Weights of vertices 1 and 2 (x, y) and the ray parameter (z) where a ray meets the triangle's plane. The weights are
// kept inside the triangle: rounding of the tracer's own test must not extrapolate attributes.
vec3 intersect_plane(WorldTriangle t, vec3 origin, vec3 direction) {
    vec3 normal = cross(t.edge1, t.edge2);
    float inverse = 1.0 / dot(normal, direction);
    vec3 to_corner = t.p0 - origin;
    float distance_along = dot(to_corner, normal) * inverse;
    vec3 turned = cross(direction, to_corner) * inverse;
    vec2 weights = clamp(vec2(-dot(turned, t.edge2), dot(turned, t.edge1)), 0.0, 1.0);
    weights /= max(1.0, weights.x + weights.y);
    return vec3(weights, distance_along);
}

vec3 world_normal(mat4x3 m, bool is_mirrored, vec3 n) {
    vec3 turned = cross(m[1], m[2]) * n.x + cross(m[2], m[0]) * n.y + cross(m[0], m[1]) * n.z;
    return is_mirrored ? -turned : turned;
}

// Shading normal with the material's normal map, in the frame of the texture coordinates.
vec3 mapped_normal(WorldTriangle t, MaterialRecord m, vec3 weights, vec3 normal, vec4 uv, mat3 uv_corners,
                   mat3 extras, float lod_offset) {
    vec3 texel = sample_texture(m.normal_use, uv, lod_offset).xyz * 2.0 - 1.0;
    texel.xy *= m.normal_scale;
    vec2 duv1 = uv_corners[1].xy - uv_corners[0].xy;
    vec2 duv2 = uv_corners[2].xy - uv_corners[0].xy;
    float area = duv1.x * duv2.y - duv1.y * duv2.x;
    vec3 tangent = (t.edge1 * duv2.y - t.edge2 * duv1.y) * sign(area);
    float handedness = area < 0.0 ? 1.0 : -1.0; // upright images have v downwards: negative area
    if (floatBitsToUint(extras[0].x) != 0xFFFFFFFFu) {
        vec3 object_tangent = unpack_normal(floatBitsToUint(extras[0].x)) * weights.x +
                              unpack_normal(floatBitsToUint(extras[1].x)) * weights.y +
                              unpack_normal(floatBitsToUint(extras[2].x)) * weights.z;
        tangent = t.world_from_object * vec4(object_tangent, 0.0);
        handedness = t.is_mirrored ? -extras[0].z : extras[0].z;
    } else if (t.is_mirrored) {
        handedness = -handedness;
    }
    tangent -= normal * dot(normal, tangent);
    float size = dot(tangent, tangent);
    if (!(size > 1e-20)) {
        return normal; // degenerate texture coordinates
    }
    tangent *= inversesqrt(size);
    // glTF: green points up in the image, against v.
    vec3 bitangent = cross(normal, tangent) * handedness;
    vec3 result = tangent * texel.x + bitangent * texel.y + normal * max(texel.z, 1e-3);
    return normalize(result);
}

// `corners`: of the first uv set, or of the second one if the normal map uses that; tangents follow it.
vec4 interpolate_uv(uvec3 vertices, vec3 weights, uint normal_use, out mat3 corners) {
    vec4 a = load_vertex_uv(vertices.x);
    vec4 b = load_vertex_uv(vertices.y);
    vec4 c = load_vertex_uv(vertices.z);
    bool second = normal_use != kNoIndex && texture_use_set(normal_use) != 0u;
    corners = second ? mat3(vec3(a.zw, 0.0), vec3(b.zw, 0.0), vec3(c.zw, 0.0))
                     : mat3(vec3(a.xy, 0.0), vec3(b.xy, 0.0), vec3(c.xy, 0.0));
    return a * weights.x + b * weights.y + c * weights.z;
}

vec4 base_colour(MaterialRecord m, vec4 uv, vec4 vertex_colour, float lod_offset) {
    vec4 colour = m.base_colour * vertex_colour;
    if (m.base_colour_use != kNoIndex) {
        colour *= sample_texture(m.base_colour_use, uv, lod_offset);
    }
    return colour;
}

// Interpolated and mapped normals may turn away from the viewer, or have a mirror direction inside the surface, which
// would be black. Bends `normal` until the mirror direction just leaves `geometric` (A. Keller et al. The Iray Light
// Transport Simulation and Rendering System. 2017, section on bent normals); others stay as they are.
vec3 bent_normal(vec3 normal, vec3 geometric, vec3 direction) {
    const float kMinCos = 1e-3; // of the mirror direction and `geometric`
    vec3 mirrored = reflect(direction, normal);
    float cos_mirrored = dot(mirrored, geometric);
    if (cos_mirrored >= kMinCos && dot(normal, direction) < 0.0) {
        return normal;
    }
    vec3 lifted = normalize(mirrored + geometric * (kMinCos - cos_mirrored));
    vec3 bent = lifted - direction;
    float size = dot(bent, bent);
    return size > 1e-12 ? bent * inversesqrt(size) : geometric;
}

// Everything about the point of `t` with `barycentrics`, seen along unit `direction`. `cone_width_m` is the width of
// the pixel's cone there, for the level of detail (T. Akenine-Möller et al. Improved Shader and Texture Level of Detail
// Using Ray Cones. JCGT 10(1), 2021).
Surface make_surface(WorldTriangle t, vec2 barycentrics, vec3 direction, float cone_width_m) {
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    MaterialRecord m = load_material(t.material);
    vec3 area_normal = cross(t.edge1, t.edge2);
    float double_area = length(area_normal);
    vec3 geometric = area_normal / max(double_area, 1e-30) * (t.is_mirrored ? -1.0 : 1.0);
    bool is_front = dot(geometric, direction) <= 0.0;

    mat3 uv_corners;
    vec4 uv = interpolate_uv(t.vertices, weights, m.normal_use, uv_corners);
    vec2 duv1 = uv_corners[1].xy - uv_corners[0].xy;
    vec2 duv2 = uv_corners[2].xy - uv_corners[0].xy;
    float uv_area = abs(duv1.x * duv2.y - duv1.y * duv2.x);
    float footprint = cone_width_m / max(abs(dot(geometric, direction)), 0.05);
    float lod_offset = log2(max(footprint, 1e-12)) + 0.5 * log2(max(uv_area, 1e-20) / max(double_area, 1e-20));
    vec4 e0 = load_vertex_extra(t.vertices.x);
    vec4 e1 = load_vertex_extra(t.vertices.y);
    vec4 e2 = load_vertex_extra(t.vertices.z);
    vec4 vertex_colour = unpackUnorm4x8(floatBitsToUint(e0.y)) * weights.x +
                         unpackUnorm4x8(floatBitsToUint(e1.y)) * weights.y +
                         unpackUnorm4x8(floatBitsToUint(e2.y)) * weights.z;

    vec3 object_normal = unpack_normal(t.normals.x) * weights.x + unpack_normal(t.normals.y) * weights.y +
                         unpack_normal(t.normals.z) * weights.z;
    vec3 normal = world_normal(t.world_from_object, t.is_mirrored, object_normal);
    float normal_size = dot(normal, normal);
    normal = normal_size > 1e-30 ? normal * inversesqrt(normal_size) : geometric;
    if (m.normal_use != kNoIndex) {
        normal = mapped_normal(t, m, weights, normal, uv, uv_corners, mat3(e0.xyz, e1.xyz, e2.xyz), lod_offset);
    }

    Surface s;
    s.position = t.p0 + t.edge1 * barycentrics.x + t.edge2 * barycentrics.y;
    s.geometric_normal = is_front ? geometric : -geometric;
    normal = is_front ? normal : -normal;
    s.normal = bent_normal(normal, s.geometric_normal, direction);
    s.area_m2 = 0.5 * double_area;

    vec4 colour = base_colour(m, uv, vertex_colour, lod_offset);
    s.metallic = m.metallic;
    s.roughness = m.roughness;
    if (m.metallic_roughness_use != kNoIndex) {
        vec4 texel = sample_texture(m.metallic_roughness_use, uv, lod_offset);
        s.roughness *= texel.g;
        s.metallic *= texel.b;
    }
    float transmission = m.transmission;
    if (m.transmission_use != kNoIndex) {
        transmission *= sample_texture(m.transmission_use, uv, lod_offset).r;
    }
    float reflectance = (m.ior - 1.0) / (m.ior + 1.0);
    vec3 dielectric = colour.rgb * (1.0 - s.metallic);
    s.diffuse_colour = dielectric * (1.0 - transmission);
    s.transmission = dielectric * transmission;
    reflectance *= reflectance;
    s.f0 = mix(vec3(reflectance), colour.rgb, s.metallic);
    // Schlick's formula takes 1, also for ior = 1 where there is no interface. Below 2 % (water) f90 falls to 0 with
    // the reflectance.
    s.f90 = mix(min(1.0, 50.0 * reflectance), 1.0, s.metallic);
    s.alpha = (m.flags & kMaterialAlphaMask) == kAlphaBlend ? colour.a : 1.0;
    s.emission = vec3(0.0);
    if ((m.flags & kMaterialEmissive) != 0u && (is_front || (m.flags & kMaterialDoubleSided) != 0u)) {
        s.emission = m.emission;
        if (m.emission_use != kNoIndex) {
            s.emission *= sample_texture(m.emission_use, uv, lod_offset).rgb;
        }
    }
    s.material = t.material;
    s.emitter = t.first_emitter == kNoIndex ? kNoIndex : t.first_emitter + t.primitive;
    return s;
}

// Alpha of a surface point at the finest level of detail; MASK and BLEND tests of the traversal.
float surface_alpha(uint instance, uint primitive, vec2 barycentrics) {
    uvec4 tail = load_placement_tail(instance);
    uvec3 vertices = load_triangle(tail.x + primitive);
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    vec4 uv = load_vertex_uv(vertices.x) * weights.x + load_vertex_uv(vertices.y) * weights.y +
              load_vertex_uv(vertices.z) * weights.z;
    int base = int(tail.y) * 5;
    float alpha = texelFetch(materials_, base).a;
    uint use = floatBitsToUint(texelFetch(materials_, base + 3).z);
    if (use != kNoIndex) {
        alpha *= sample_texture(use, uv, -100.0).a;
    }
    float colour_alpha = dot(weights, vec3(unpackUnorm4x8(floatBitsToUint(load_vertex_extra(vertices.x).y)).a,
                                           unpackUnorm4x8(floatBitsToUint(load_vertex_extra(vertices.y).y)).a,
                                           unpackUnorm4x8(floatBitsToUint(load_vertex_extra(vertices.z).y)).a));
    return clamp(alpha * colour_alpha, 0.0, 1.0);
}

bool surface_is_solid_at(uint instance, uint primitive, vec2 barycentrics) {
    uint material = load_placement_tail(instance).y;
    float cutoff = texelFetch(materials_, int(material) * 5 + 1).w;
    return surface_alpha(instance, primitive, barycentrics) >= cutoff;
}

#endif
