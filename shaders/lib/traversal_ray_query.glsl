// SPDX-License-Identifier: Apache-2.0
// Traversal through VK_KHR_ray_query; included by lib/traversal.glsl only. One bottom level per mesh. The custom index
// of an instance is its index in the scene, with the alpha mode of its material above (kRayQueryAlphaShift).
// Geometries that are not opaque report their candidates.
#extension GL_EXT_ray_query : require

layout(set = 0, binding = kBindAcceleration) uniform accelerationStructureEXT top_level_;

uint instance_of(uint custom_index) {
    return custom_index & ((1u << kRayQueryAlphaShift) - 1u);
}

Hit trace_closest(vec3 origin, vec3 direction, float t_min, float t_max, uint mode, uint seed) {
    rayQueryEXT query;
    uint flags = kSceneHasAlpha ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT;
    if (mode == kTraceBlend) {
        flags = gl_RayFlagsCullOpaqueEXT;
    }
    rayQueryInitializeEXT(query, top_level_, flags, 0xFFu, origin, t_min, direction, t_max);
    while (rayQueryProceedEXT(query)) {
        uint custom_index = rayQueryGetIntersectionInstanceCustomIndexEXT(query, false);
        uint instance = instance_of(custom_index);
        uint primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
        vec2 barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, false);
        if (alpha_accepts(custom_index >> kRayQueryAlphaShift, mode, seed, instance, primitive, barycentrics)) {
            rayQueryConfirmIntersectionEXT(query);
        }
    }
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) {
        return Hit(t_max, kNoInstance, 0u, vec2(0.0));
    }
    return Hit(rayQueryGetIntersectionTEXT(query, true),
               instance_of(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)),
               rayQueryGetIntersectionPrimitiveIndexEXT(query, true),
               rayQueryGetIntersectionBarycentricsEXT(query, true));
}

float trace_transmittance(vec3 origin, vec3 direction, float t_max) {
    rayQueryEXT query;
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | (kSceneHasAlpha ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT);
    float transmittance = 1.0;
    rayQueryInitializeEXT(query, top_level_, flags, 0xFFu, origin, 0.0, direction, t_max);
    while (rayQueryProceedEXT(query)) {
        uint custom_index = rayQueryGetIntersectionInstanceCustomIndexEXT(query, false);
        uint instance = instance_of(custom_index);
        uint primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
        vec2 barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, false);
        if (custom_index >> kRayQueryAlphaShift == kAlphaBlend) {
            transmittance *= 1.0 - surface_alpha(instance, primitive, barycentrics);
        } else if (surface_is_solid_at(instance, primitive, barycentrics)) {
            rayQueryConfirmIntersectionEXT(query);
        }
    }
    bool is_blocked = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
    return is_blocked ? 0.0 : transmittance;
}
