// SPDX-License-Identifier: Apache-2.0
// Width of the lobe that a surface reflects.
#ifndef FIELDCAST_LIB_LOBE
#define FIELDCAST_LIB_LOBE

// Half angle of the cone that holds 75 % of the light that GGX reflects at normal incidence: atan(√3 α).
float lobe_angle(float roughness) {
    return atan(1.7320508 * roughness * roughness);
}

// exp(−angle² · falloff) is the weight of the light of one lobe in another that is turned away from it by `angle`. It
// is one half at three times lobe_angle. There, the smear of old and of neighbouring light and the noise without them
// cause about the same error (docs/lightfield.md). Lobes count as no narrower than half a pixel.
float lobe_falloff(float roughness, float pixel_angle) {
    float reach = 3.0 * max(lobe_angle(roughness), 0.5 * pixel_angle);
    return 0.6931472 / (reach * reach);
}

#endif
