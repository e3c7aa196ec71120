// SPDX-License-Identifier: Apache-2.0
// Unidirectional path tracing with next event estimation from a surface that is already known.
// MIS: E. Veach, L. Guibas. Optimally Combining Sampling Techniques for Monte Carlo Rendering. 1995 (power heuristic).
#ifndef FIELDCAST_LIB_PATH
#define FIELDCAST_LIB_PATH
#include "lib/lights.glsl"
#include "lib/ray_origin.glsl"
#include "lib/traversal.glsl"
#ifdef PATH_ENDS_IN_KNOWN_LIGHT
// The including kernel defines this: whether the light that `s`, at `barycentrics` of `t`, reflects to any viewer is
// known already. Paths end there.
bool known_light(WorldTriangle t, vec2 barycentrics, Surface s, Bsdf b, out vec3 reflected);
#endif

struct PathSettings {
    uint max_bounces;
    bool next_event_estimation;
    uint light_candidates;
    bool each_light_kind; // at the first vertex
    float max_indirect;   // luminance of one indirect contribution; 0: no limit
};

PathSettings make_path_settings(uint path, float max_indirect) {
    return PathSettings(path & 0xFFFFu, (path & kPathNextEventEstimation) != 0u, (path >> kPathCandidatesShift) & 0xFFu,
                        (path & kPathEachLightKind) != 0u, max_indirect);
}

// Light arriving at the first surface, demodulated: reflected diffusely by diffuse_modulation = 1, specularly over
// specular_modulation.
struct Illumination {
    vec3 diffuse;
    vec3 specular;
    vec3 punctual; // if each kind of light has a sample: diffuse, directly from punctual lights; not in `diffuse`
};
const Illumination kNoIllumination = Illumination(vec3(0.0), vec3(0.0), vec3(0.0));

float power_heuristic(float a, float b) { // a > 0; squares of densities themselves may overflow
    float ratio = b / a;
    return 1.0 / (1.0 + ratio * ratio);
}

// Directions must lie on the same side of the shading and the geometric normal.
bool is_consistent(Surface s, vec3 direction, float local_z) {
    return dot(s.geometric_normal, direction) * local_z > 0.0;
}

// Kinds of light that one sample of next event estimation stands for: part [from, to) of sample_light's `choice`.
struct LightShare {
    float from;
    float to;
};

const uint kEnvironmentKind = 0u;
const uint kPunctualKind = 2u;

LightShare share_of_kind(SceneInfo info, uint kind) {
    float environment = info.probability_environment;
    float emitters = environment + info.probability_emitter;
    return kind == 0u ? LightShare(0.0, environment)
                      : (kind == 1u ? LightShare(environment, emitters) : LightShare(emitters, emitters + info.probability_light));
}

// Candidates of one sample of next event estimation at vertex `bounce`. From the third vertex on more than one costs
// more than it saves in noise.
uint candidates_at(PathSettings settings, uint bounce) {
    return bounce < 2u ? settings.light_candidates : 1u;
}

// Candidates of a sample of `kind`, if each kind has a sample. The environment has one, because its candidates would
// have the same place in it; a single lamp or sun leaves no choice.
uint candidates_of_kind(SceneInfo info, uint candidates, bool each_kind, uint kind) {
    bool is_one = kind == kEnvironmentKind || (kind == kPunctualKind && info.light_count == 1u);
    return each_kind && is_one ? 1u : candidates;
}

// A light sample chosen from `candidates` by the light that it would reflect if nothing blocked it, and weighted
// against the BSDF's sampling. Its weight is light without the surface's reflection, zero if no candidate reflects.
// Resampled importance sampling: J. Talbot, D. Cline, P. Egbert. EGSR 2005. Candidates are stratified over `choice`,
// have the same `u`, and `pick` decides between them: the sample stays well distributed if those are. The power
// heuristic counts as many samples as there are candidates.
LightSample resample_light(SceneInfo info, Surface s, Bsdf b, LightShare share, uint candidates, float choice, vec2 u,
                           inout float pick, out BsdfValue value) {
    float span = share.to - share.from;
    LightSample kept = LightSample(s.normal, 0.0, vec3(0.0), 1.0);
    value = BsdfValue(vec3(0.0), vec3(0.0), 0.0);
    float kept_mass = 1.0;
    float total = 0.0;
    for (uint i = 0u; i < candidates; ++i) {
        float stratum = (float(i) + choice) / float(candidates);
        LightSample light = sample_light(info, s.position, s.normal, share.from + span * stratum,
                                         u);
        vec3 local = light.direction * b.world_from_local;
        BsdfValue reflected = eval_bsdf(b, local);
        // The albedo has a floor, because filters spread the demodulated light of dark texels to bright ones.
        float mass = luminance(light.weight * (reflected.diffuse * (b.diffuse_modulation + 0.1) + reflected.specular));
        if (!is_consistent(s, light.direction, local.z) || !(mass > 0.0)) {
            continue;
        }
        float density = float(candidates) * light.pdf / span;
        float mis = light.pdf == kDeltaLight ? 1.0 : power_heuristic(density, reflected.pdf);
        light.weight *= mis * span;
        mass *= mis * span;
        total += mass;
        float share_of_new = mass / total;
        bool is_new = pick < share_of_new;
        // What is left of the random number after the choice is uniform again.
        pick = min(is_new ? pick / share_of_new : (pick - share_of_new) / (1.0 - share_of_new), 0.99999994);
        if (is_new) {
            kept = light;
            kept_mass = mass;
            value = reflected;
        }
    }
    kept.weight *= total / (kept_mass * float(candidates));
    return kept;
}

// Light of one next event estimation sample, without the surface's reflection; zero if it is blocked.
vec3 sample_direct(SceneInfo info, Surface s, Bsdf b, LightShare share, uint candidates, float choice, vec2 u,
                   inout float pick, out BsdfValue value) {
    LightSample light = resample_light(info, s, b, share, candidates, choice, u, pick, value);
    if (luminance(light.weight) <= 0.0) {
        return vec3(0.0);
    }
    // From the moved origin to the exact point that was sampled: a ray along the old direction could reach a near
    // emitter before its end.
    vec3 origin = path_origin(s, light.direction);
    bool is_far = light.distance_m > 1e20;
    vec3 to_light = is_far ? light.direction : s.position + light.direction * light.distance_m - origin;
    float visible = trace_transmittance(origin, to_light, is_far ? 1e30 : 0.9999);
    return light.weight * visible;
}

// Emission met by a sampled direction, weighted against next event estimation.
vec3 emitted_light(SceneInfo info, PathSettings settings, bool each_kind, uint candidates, Surface s, vec3 direction,
                   float distance_m, float pdf) {
    if (!settings.next_event_estimation || s.emitter == kNoIndex) {
        return s.emission;
    }
    float cos_light = abs(dot(s.geometric_normal, direction));
    float expected = each_kind ? 1.0 : info.probability_emitter;
    float light_pdf = expected * float(candidates) * pdf_emitter(s.emitter, s.area_m2, distance_m, cos_light);
    return s.emission * power_heuristic(pdf, light_pdf);
}

vec3 environment_light(SceneInfo info, PathSettings settings, bool each_kind, uint candidates, vec3 normal,
                       vec3 direction, float pdf) {
    vec3 radiance = environment_radiance(info, direction);
    if (!settings.next_event_estimation || info.probability_environment == 0.0) {
        return radiance;
    }
    float expected = each_kind ? 1.0 : info.probability_environment;
    uint count = candidates_of_kind(info, candidates, each_kind, kEnvironmentKind);
    float light_pdf = expected * float(count) * pdf_environment(info, normal, direction);
    return radiance * power_heuristic(pdf, light_pdf);
}

vec3 limit_luminance(vec3 c, float limit) {
    float l = luminance(c);
    return limit > 0.0 && l > limit ? c * (limit / l) : c;
}

// One path from `s`, seen along unit `direction`; `cone_width_m` and `cone_spread` for texture detail.
Illumination trace_path(SceneInfo info, PathSettings settings, Surface s, vec3 direction, float cone_width_m,
                        float cone_spread, inout Sampler rng) {
    Illumination result = kNoIllumination;
    Bsdf b = make_bsdf(s, direction);
    vec3 modulation = b.specular_modulation;
    vec3 first_diffuse = vec3(0.0); // of the first vertex's sampled direction: value over density
    vec3 first_specular = vec3(0.0);
    vec3 throughput = vec3(1.0);    // from the second vertex on
    vec3 indirect = vec3(0.0);

    for (uint bounce = 0u; bounce < settings.max_bounces; ++bounce) {
        bool each_kind = settings.each_light_kind && bounce == 0u;
        uint candidates = candidates_at(settings, bounce);
        vec2 choices = next_pair(rng);
        vec2 light_u = next_pair(rng);
        vec2 bsdf_u = next_pair(rng);
        vec2 picks = next_pair(rng); // of the candidate, of going on
        if (settings.next_event_estimation) {
            for (uint kind = 0u; kind < (each_kind ? 3u : 1u); ++kind) {
                LightShare share = each_kind ? share_of_kind(info, kind) : LightShare(0.0, 1.0);
                if (share.to - share.from < 1e-6) {
                    continue;
                }
                BsdfValue value;
                uint choice_count = candidates_of_kind(info, candidates, each_kind, kind);
                vec3 light = sample_direct(info, s, b, share, choice_count, choices.x, light_u, picks.x, value);
                if (bounce == 0u) {
                    if (each_kind && kind == kPunctualKind) {
                        result.punctual = light * value.diffuse;
                    } else {
                        result.diffuse += light * value.diffuse;
                    }
                    result.specular += light * value.specular / modulation;
                } else {
                    indirect += throughput * light * (value.diffuse * b.diffuse_modulation + value.specular);
                }
            }
        }
        vec3 local = sample_bsdf(b, choices.y, bsdf_u);
        BsdfValue value = eval_bsdf(b, local);
        direction = normalize(b.world_from_local * local);
        if (!(value.pdf > 0.0) || !is_consistent(s, direction, local.z)) {
            break;
        }
        if (bounce == 0u) {
            first_diffuse = value.diffuse / value.pdf;
            first_specular = value.specular / (value.pdf * modulation);
        } else {
            throughput *= (value.diffuse * b.diffuse_modulation + value.specular) / value.pdf;
        }
        if (bounce >= 3u) { // Russian roulette
            float survival = clamp(max(throughput.r, max(throughput.g, throughput.b)), 0.05, 0.95);
            if (picks.y >= survival) {
                break;
            }
            throughput /= survival;
        }
        vec3 normal = s.normal;
        uint alpha_seed = hash_combine(rng.state, bounce); // BLEND surfaces are drawn anew for every segment
        Hit hit = trace_closest(path_origin(s, direction), direction, 0.0, 1e30, kTraceStochastic, alpha_seed);
        vec3 arriving;
        bool ends = hit.instance == kNoInstance;
        if (ends) {
            arriving = environment_light(info, settings, each_kind, candidates, normal, direction, value.pdf);
        } else {
            cone_spread += 0.1 * sqrt(b.alpha);
            cone_width_m += cone_spread * hit.t;
            WorldTriangle triangle = load_world_triangle(hit.instance, hit.primitive);
            s = make_surface(triangle, hit.barycentrics, direction, cone_width_m);
            arriving = emitted_light(info, settings, each_kind, candidates, s, direction, hit.t, value.pdf);
            b = make_bsdf(s, direction);
#ifdef PATH_ENDS_IN_KNOWN_LIGHT
            vec3 reflected;
            ends = bounce + 1u < settings.max_bounces && known_light(triangle, hit.barycentrics, s, b, reflected);
            arriving += ends ? reflected : vec3(0.0);
#endif
        }
        if (bounce == 0u) {
            result.diffuse += first_diffuse * arriving;
            result.specular += first_specular * arriving;
        } else {
            indirect += throughput * arriving;
        }
        if (ends) {
            break;
        }
    }
    indirect = limit_luminance(indirect, settings.max_indirect);
    result.diffuse += first_diffuse * indirect;
    result.specular += first_specular * indirect;
    return result;
}

bool is_finite(vec3 c) {
    return !(any(isnan(c)) || any(isinf(c)));
}

#endif
