// SPDX-License-Identifier: Apache-2.0
// Stands in for lib/surface.glsl in kernels that know geometry only: every surface is solid.
#ifndef FIELDCAST_LIB_TRAVERSAL_SOLID
#define FIELDCAST_LIB_TRAVERSAL_SOLID

bool surface_is_solid_at(uint instance, uint primitive, vec2 barycentrics) {
    return true;
}

float surface_alpha(uint instance, uint primitive, vec2 barycentrics) {
    return 1.0;
}

#endif
