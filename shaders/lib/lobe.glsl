// SPDX-License-Identifier: Apache-2.0
// How wide the light is that a surface reflects.
#ifndef FIELDCAST_LIB_LOBE
#define FIELDCAST_LIB_LOBE

// Half angle of the cone that holds 75 % of what GGX reflects at normal incidence: atan(√3 α).
float lobe_angle(float roughness) {
    return atan(1.7320508 * roughness * roughness);
}

// exp(−angle² · falloff): how much of the light of one lobe says something about another that is turned away from it by
// `angle`; half of it at three times lobe_angle, where the smear of old and of neighbouring light and the noise without
// them err about the same (docs/lightfield.md). Lobes count as no narrower than half a pixel.
float lobe_falloff(float roughness, float pixel_angle) {
    float reach = 3.0 * max(lobe_angle(roughness), 0.5 * pixel_angle);
    return 0.6931472 / (reach * reach);
}

#endif
