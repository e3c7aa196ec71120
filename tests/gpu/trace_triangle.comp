// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
#include "shared/types.h"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT world;
layout(push_constant, scalar) uniform Push {
    Vec4Buffer origins; // xyz; rays go along -z
    Vec4Buffer hits;    // t or -1, custom index, primitive, candidates seen
    uint accept;        // candidates are hits
    uint unused;
};

void main() {
    const uint index = gl_GlobalInvocationID.x;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, world, gl_RayFlagsNoneEXT, 0xFF, origins.at[index].xyz, 0.0, vec3(0, 0, -1), 100.0);
    uint candidates = 0;
    while (rayQueryProceedEXT(query)) {
        ++candidates;
        if (accept != 0) {
            rayQueryConfirmIntersectionEXT(query);
        }
    }
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
        hits.at[index] = vec4(rayQueryGetIntersectionTEXT(query, true),
                              rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
                              rayQueryGetIntersectionPrimitiveIndexEXT(query, true), candidates);
    } else {
        hits.at[index] = vec4(-1, 0, 0, candidates);
    }
}
