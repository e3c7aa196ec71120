// SPDX-License-Identifier: Apache-2.0
// glTF metallic-roughness as a sum of three lobes: Lambert, GGX reflection, thin-walled GGX transmission.
// GGX: B. Walter et al. Microfacet Models for Refraction through Rough Surfaces. EGSR 2007; height-correlated Smith.
// Visible normals: J. Dupuy, A. Benyoub. Sampling Visible GGX Normals with Spherical Caps. CGF 42(8), 2023.
// Multiple scattering: E. Turquin. Practical multiple scattering compensation for microfacet models. 2019.
// Differs from glTF's appendix B: reflection leaves 1 − its directional albedo to the other lobes instead of 1 −
// F(v·h), so that the lobes together reflect no more than the incident light (albedo scaling, as in Turquin's section
// 6).
// All directions are unit vectors in the frame of the shading normal (z), pointing away from the surface.
#ifndef FIELDCAST_LIB_BSDF
#define FIELDCAST_LIB_BSDF
#include "lib/random.glsl"
#include "lib/surface.glsl"

const float kPi = 3.14159265358979;

float luminance(vec3 c) {
    return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

// T. Duff et al. Building an Orthonormal Basis, Revisited. JCGT 6(1), 2017.
mat3 frame_of(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// Directional albedo of single-scattering GGX as F0·x + y.
vec2 ggx_albedo(float cos_view, float roughness) {
    float size = float(kGgxAlbedoSize);
    vec2 at = clamp(vec2(cos_view * size - 0.5, roughness * (size - 1.0)), 0.0, size - 1.0);
    ivec2 low = ivec2(min(at, size - 2.0));
    vec2 f = at - vec2(low);
    int base = low.y * int(kGgxAlbedoSize) + low.x;
    vec2 top = mix(texelFetch(ggx_albedo_, base).xy, texelFetch(ggx_albedo_, base + 1).xy, f.x);
    base += int(kGgxAlbedoSize);
    vec2 bottom = mix(texelFetch(ggx_albedo_, base).xy, texelFetch(ggx_albedo_, base + 1).xy, f.x);
    return mix(top, bottom, f.y);
}

// Parameters of the BSDF at one surface point for one viewing direction, for evaluation and sampling.
struct Bsdf {
    mat3 world_from_local;
    vec3 view;                // local, towards the viewer
    vec3 f0;
    float f90;
    vec3 compensation;        // of the reflection
    vec3 transmission;        // scale of the transmitted lobe
    float alpha;              // GGX
    vec3 diffuse_modulation;  // factor of diffuse illumination
    vec3 specular_modulation; // divisor of specular illumination, and its factor later
    float probability_diffuse;
    float probability_specular;
    float probability_transmission;
};

Bsdf make_bsdf(Surface s, vec3 direction) {
    Bsdf b;
    b.world_from_local = frame_of(s.normal);
    b.view = -direction * b.world_from_local;
    b.view.z = max(b.view.z, 1e-4);
    b.f0 = s.f0;
    b.f90 = s.f90;
    b.alpha = max(s.roughness * s.roughness, 1e-3);
    vec2 albedo = ggx_albedo(b.view.z, s.roughness);
    float single = max(albedo.x + albedo.y, 1e-3); // of a lobe that reflects everything once
    b.compensation = 1.0 + s.f0 * (1.0 / single - 1.0);
    vec3 reflected = (s.f0 * albedo.x + s.f90 * albedo.y) * b.compensation;
    vec3 rest = max(vec3(0.0), 1.0 - reflected);
    b.transmission = rest * s.transmission / single;
    b.diffuse_modulation = rest * s.diffuse_colour;
    b.specular_modulation = max(reflected + rest * s.transmission, vec3(1e-3));
    float specular = luminance(reflected);
    float diffuse = luminance(b.diffuse_modulation);
    float transmitted = luminance(rest * s.transmission);
    float total = max(specular + diffuse + transmitted, 1e-6);
    b.probability_diffuse = diffuse > 0.0 ? max(diffuse / total, 0.05) : 0.0;
    b.probability_transmission = transmitted > 0.0 ? max(transmitted / total, 0.05) : 0.0;
    b.probability_specular = specular > 0.0 ? max(specular / total, 0.05) : 0.0;
    float sum = max(b.probability_diffuse + b.probability_transmission + b.probability_specular, 1e-6);
    b.probability_diffuse /= sum;
    b.probability_transmission /= sum;
    b.probability_specular /= sum;
    return b;
}

// The sine comes from x and y: 1 − cos² would lose all digits for small α.
float ggx_distribution(vec3 half_vector, float alpha) {
    float a2 = alpha * alpha;
    float d = dot(half_vector.xy, half_vector.xy) + a2 * half_vector.z * half_vector.z;
    return a2 / (kPi * d * d);
}

float smith_lambda_term(float cos_theta, float alpha) { // √(α² + (1 − α²) cos²)
    float a2 = alpha * alpha;
    return sqrt(a2 + (1.0 - a2) * cos_theta * cos_theta);
}

// Height-correlated visibility G2 / (4 n·l n·v).
float ggx_visibility(float cos_light, float cos_view, float alpha) {
    return 0.5 / (cos_light * smith_lambda_term(cos_view, alpha) + cos_view * smith_lambda_term(cos_light, alpha));
}

vec3 fresnel(vec3 f0, float f90, float cos_view_half) { // Schlick
    float m = clamp(1.0 - cos_view_half, 0.0, 1.0);
    float m2 = m * m;
    return f0 + (f90 - f0) * (m2 * m2 * m);
}

// Value of the BSDF times |cos|, split for demodulation, with the density of sample_bsdf.
struct BsdfValue {
    vec3 diffuse;  // without diffuse_modulation
    vec3 specular; // reflection and transmission
    float pdf;
};

BsdfValue eval_bsdf(Bsdf b, vec3 light) {
    BsdfValue value = BsdfValue(vec3(0.0), vec3(0.0), 0.0);
    float cos_light = abs(light.z);
    if (cos_light < 1e-6) {
        return value;
    }
    bool is_reflection = light.z > 0.0;
    vec3 mirrored = vec3(light.xy, cos_light); // a thin wall transmits what it would reflect, mirrored to its back
    vec3 half_vector = normalize(b.view + mirrored);
    float distribution = ggx_distribution(half_vector, b.alpha);
    float lobe = distribution * ggx_visibility(cos_light, b.view.z, b.alpha) * cos_light;
    // Density of a direction reflected at a visible normal: D · G1 / (4 n·v).
    float pdf = 0.5 * distribution / (b.view.z + smith_lambda_term(b.view.z, b.alpha));
    if (is_reflection) {
        float lambert = cos_light / kPi;
        value.specular = fresnel(b.f0, b.f90, dot(b.view, half_vector)) * b.compensation * lobe;
        value.diffuse = vec3(b.probability_diffuse > 0.0 ? lambert : 0.0); // metals would only add noise to store
        value.pdf = b.probability_specular * pdf + b.probability_diffuse * lambert;
    } else {
        value.specular = b.transmission * lobe;
        value.pdf = b.probability_transmission * pdf;
    }
    return value;
}

vec3 sample_visible_normal(vec3 view, float alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * view.xy, view.z));
    float phi = 2.0 * kPi * u.x;
    float z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    float s = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3 h = vec3(s * cos(phi), s * sin(phi), z) + stretched;
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-6)));
}

// Draws a direction; its value and density come from eval_bsdf. z = 0: no direction.
vec3 sample_bsdf(Bsdf b, float choice, vec2 u) {
    if (choice < b.probability_diffuse) {
        float r = sqrt(u.x);
        float phi = 2.0 * kPi * u.y;
        return vec3(r * cos(phi), r * sin(phi), sqrt(max(0.0, 1.0 - u.x)));
    }
    vec3 light = reflect(-b.view, sample_visible_normal(b.view, b.alpha, u));
    if (light.z <= 0.0) {
        return vec3(0.0); // below the horizon: energy the compensation accounts for
    }
    bool transmits = choice >= b.probability_diffuse + b.probability_specular;
    return transmits ? vec3(light.xy, -light.z) : light;
}

#endif
