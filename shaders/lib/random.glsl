// SPDX-License-Identifier: Apache-2.0
// Random numbers: hashed Owen-scrambled Sobol pairs for the first dimensions of a path, PCG beyond.
// Follows: B. Burley. Practical Hash-based Owen Scrambling. JCGT 9(4), 2020. The scrambling hash is
// that of Laine and Karras with the constants of N. Vegdahl (2021).
#ifndef FIELDCAST_LIB_RANDOM
#define FIELDCAST_LIB_RANDOM

// M. Jarzynski, M. Olano. Hash Functions for GPU Rendering. JCGT 9(3), 2020: pcg.
uint pcg_hash(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

uint hash_combine(uint a, uint b) {
    return pcg_hash(a ^ (b + 0x9E3779B9u + (a << 6) + (a >> 2)));
}

// Uniform in [0, 1) from the 24 high bits.
float unit_float(uint bits) {
    return float(bits >> 8) * (1.0 / 16777216.0);
}

// One path's supply of random numbers.
struct Sampler {
    uint seed;      // of this pixel, or of all pixels
    uint index;     // sample number in the sequence
    uint place;     // of the pixel along a Z-order curve; kNoPlace: the seed is this pixel's own
    uint dimension; // counts pairs
    uint state;     // PCG, for dimensions beyond the Sobol ones
};

const uint kSobolPairs = 16u;
const uint kSobolIndexMask = 0xFFFu; // sequences of 4096 points; longer ones start over with another seed

const uint kNoPlace = 0xFFFFFFFFu;

uint epoch_seed(uint seed, uint index) {
    uint epoch = index & ~kSobolIndexMask;
    return epoch == 0u ? seed : hash_combine(seed, epoch);
}

Sampler make_sampler(uint seed, uint index) {
    uint mixed = epoch_seed(seed, index);
    return Sampler(mixed, index & kSobolIndexMask, kNoPlace, 0u, hash_combine(mixed, index));
}

uint spread_bits(uint value) { // of 16 bits, to the even ones
    value = (value | (value << 8)) & 0x00FF00FFu;
    value = (value | (value << 4)) & 0x0F0F0F0Fu;
    value = (value | (value << 2)) & 0x33333333u;
    return (value | (value << 1)) & 0x55555555u;
}

// One sequence for all pixels, shifted in each by a point of another sequence that follows a Z-order curve across the
// image. Successive samples of a pixel and those of neighbouring pixels both fill the unit square evenly, so that
// averages over frames or neighbours have less noise. After: A. Ahmed, P. Wonka. Screen-Space Blue-Noise Diffusion of
// Monte Carlo Sampling Error via Hierarchical Ordering of Pixels. ACM TOG 39(6), 2020. Differs: the curve only shifts.
Sampler make_screen_sampler(uint seed, uint index, uvec2 pixel) {
    uint mixed = epoch_seed(seed, index);
    uint place = spread_bits(pixel.x) | (spread_bits(pixel.y) << 1);
    return Sampler(mixed, index & kSobolIndexMask, place, 0u, hash_combine(hash_combine(mixed, place), index));
}

uint scramble_reversed(uint value, uint seed) {
    value ^= value * 0x3d20adeau;
    value += seed;
    value *= (seed >> 16) | 1u;
    value ^= value * 0x05526c56u;
    value ^= value * 0x53a22864u;
    return value;
}

uint owen_scramble(uint value, uint seed) {
    return bitfieldReverse(scramble_reversed(bitfieldReverse(value), seed));
}

// Second Sobol dimension.
uint sobol_second(uint index) {
    uint result = 0u;
    for (uint direction = 0x80000000u; index != 0u; index >>= 1u, direction ^= direction >> 1u) {
        if ((index & 1u) != 0u) {
            result ^= direction;
        }
    }
    return result;
}

float next_float(inout Sampler rng) {
    rng.state = rng.state * 747796405u + 2891336453u;
    uint word = ((rng.state >> ((rng.state >> 28u) + 4u)) ^ rng.state) * 277803737u;
    return unit_float((word >> 22u) ^ word);
}

// Owen-scrambled Sobol point. Scrambling permutes the bits of the index in `mask`, block by aligned block: pairs become
// independent, and any 2^k samples that start at a multiple of 2^k stay well distributed in two dimensions.
uvec2 sobol_pair(uint index, uint mask, uint seed) {
    index = owen_scramble(index, seed) & mask;
    return uvec2(owen_scramble(bitfieldReverse(index), pcg_hash(seed)),
                 owen_scramble(sobol_second(index), pcg_hash(seed ^ 0xB5297A4Du)));
}

vec2 next_pair(inout Sampler rng) {
    uint dimension = rng.dimension++;
    if (dimension >= kSobolPairs) {
        float first = next_float(rng);
        return vec2(first, next_float(rng));
    }
    uint seed = hash_combine(rng.seed, dimension);
    uvec2 point = sobol_pair(rng.index, kSobolIndexMask, seed);
    if (rng.place != kNoPlace) {
        point ^= sobol_pair(rng.place, 0xFFFFFFFFu, pcg_hash(seed ^ 0x68E31DA4u));
    }
    return vec2(unit_float(point.x), unit_float(point.y));
}

#endif
