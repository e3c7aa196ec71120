// SPDX-License-Identifier: Apache-2.0
// Traversal of our own BVH (shared/bvh.h); included by lib/traversal.glsl only.
// Designed for software Vulkan, where lanes step together and every texel fetch and private array access is scalar
// code. A node costs three fetches and at most one stack entry, and its leaves are tested together with it. An entry is
// a *group*: the children of one node that are still to be visited, nearest first.
//
//   bits 0..23  index of the node's first inner child
//   bits 24..29 slots of the remaining children, 2 bits each, next one lowest
//   bits 30..31 how many remain; 0 on the stack: leave the bottom level

layout(constant_id = 102) const bool kTwoLevel = true; // kSpecialiseTwoLevel

layout(set = 0, binding = kBindNodes) uniform usamplerBuffer bvh_nodes_;
layout(set = 0, binding = kBindLeafTriangles) uniform usamplerBuffer bvh_triangles_;
layout(set = 0, binding = kBindTopLevel) uniform usamplerBuffer bvh_placed_levels_;

const uint kNoGroup = 0u;
const uint kMissKey = 0xFFFFFFFFu;

// The search of a ray, and its result so far.
struct BvhQuery {
    float t_min;
    uint mode;
    uint seed;
    bool any;            // any solid surface ends the search; BLEND surfaces dim `transmittance`
    Hit hit;             // hit.t: farther surfaces do not count
    float transmittance;
};

// A ray in the space of the level being traversed.
struct BvhRay {
    vec3 origin;
    vec3 direction;
    vec3 inverse;        // 1 / direction, finite
    uint first_instance; // of the level
};

// State of a traversal.
struct BvhCursor {
    uint node;     // to be visited
    uint group;
    float group_t; // entry distance of the group's next child
    int height;    // of the stack
};
uint bvh_stack_[kBvhStackSize];
float bvh_stack_t_[kBvhStackSize];

BvhRay make_bvh_ray(vec3 origin, vec3 direction, uint first_instance) {
    // Tiny components stand in for zeros, so that no plane distance is 0 · inf.
    vec3 magnitude = max(abs(direction), vec3(1e-18));
    vec3 inverse = vec3(direction.x < 0.0 ? -1.0 : 1.0, direction.y < 0.0 ? -1.0 : 1.0, direction.z < 0.0 ? -1.0 : 1.0);
    return BvhRay(origin, direction, inverse / magnitude, first_instance);
}

vec4 unpack_planes(uint packed) {
    return vec4(float(int(packed & 255u)), float(int((packed >> 8) & 255u)), float(int((packed >> 16) & 255u)),
                float(int(packed >> 24)));
}

// Distances to the near and far planes of the four children along one axis.
void plane_distances(uint low, uint high, float cell, float offset, bool reversed, out vec4 near, out vec4 far) {
    near = unpack_planes(reversed ? high : low) * cell + offset;
    far = unpack_planes(reversed ? low : high) * cell + offset;
}

float cell_size(uint shape, uint axis) {
    uint exponent = (shape >> (kBvhExponentBits * axis)) & ((1u << kBvhExponentBits) - 1u);
    return uintBitsToFloat((exponent + 127u - kBvhExponentBias) << 23);
}

// Entry distances of the four children, and which of them the ray meets.
bvec4 meet_children(uvec4 head, uvec4 planes, uvec2 planes_z, BvhRay ray, float t_min, float t_max, out vec4 entry) {
    vec3 cell = vec3(cell_size(head.w, 0u), cell_size(head.w, 1u), cell_size(head.w, 2u)) * ray.inverse;
    vec3 offset = (uintBitsToFloat(head.xyz) - ray.origin) * ray.inverse;
    vec4 near_x, near_y, near_z, far_x, far_y, far_z;
    plane_distances(planes.x, planes.y, cell.x, offset.x, ray.inverse.x < 0.0, near_x, far_x);
    plane_distances(planes.z, planes.w, cell.y, offset.y, ray.inverse.y < 0.0, near_y, far_y);
    plane_distances(planes_z.x, planes_z.y, cell.z, offset.z, ray.inverse.z < 0.0, near_z, far_z);
    entry = max(max(near_x, near_y), max(near_z, vec4(t_min)));
    vec4 leave = min(min(far_x, far_y), min(far_z, vec4(t_max)));
    return lessThanEqual(entry, leave);
}

// T. Möller, B. Trumbore. Fast, Minimum Storage Ray/Triangle Intersection. 1997. Returns (t, u, v); t < 0: missed.
vec3 meet_triangle(vec3 origin, vec3 direction, vec3 vertex, vec3 edge1, vec3 edge2) {
    vec3 p = cross(direction, edge2);
    float inverse = 1.0 / dot(edge1, p);
    vec3 s = origin - vertex;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, edge1);
    float v = dot(direction, q) * inverse;
    bool inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0; // false for NaN: degenerate triangles are never met
    return vec3(inside ? dot(edge2, q) * inverse : -1.0, u, v);
}

// A triangle whose material is MASK or BLEND was met.
void meet_alpha(inout BvhQuery query, uint alpha_mode, float t, uint instance, uint primitive, vec2 barycentrics) {
    if (query.any && alpha_mode == kAlphaBlend) {
        query.transmittance *= 1.0 - surface_alpha(instance, primitive, barycentrics);
    } else if (alpha_accepts(alpha_mode, query.mode, query.seed, instance, primitive, barycentrics)) {
        query.hit = Hit(t, instance, primitive, barycentrics);
    }
}

void test_triangle(inout BvhQuery query, BvhRay ray, uint index) {
    int texel = int(index * 3u);
    uvec4 a = texelFetch(bvh_triangles_, texel);
    uvec4 b = texelFetch(bvh_triangles_, texel + 1);
    uvec4 c = texelFetch(bvh_triangles_, texel + 2);
    vec3 met = meet_triangle(ray.origin, ray.direction, uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz),
                             uintBitsToFloat(c.xyz));
    if (met.x > query.t_min && met.x < query.hit.t) {
        uint instance = a.w + ray.first_instance;
        if (kSceneHasAlpha && (c.w & kMaterialAlphaMask) != kAlphaOpaque) {
            meet_alpha(query, c.w & kMaterialAlphaMask, met.x, instance, b.w, met.yz);
        } else if (!kSceneHasAlpha || query.mode != kTraceBlend) {
            query.hit = Hit(met.x, instance, b.w, met.yz);
        }
    }
}

bool is_finished(BvhQuery query) {
    return query.any && query.hit.instance != kNoInstance;
}

uvec4 child_kinds(uint shape) {
    return (uvec4(shape) >> (kBvhKindShift + kBvhKindBits * uvec4(0u, 1u, 2u, 3u))) & ((1u << kBvhKindBits) - 1u);
}

// Tests the triangles of all leaf children that were met.
void test_leaves(inout BvhQuery query, BvhRay ray, uvec4 kind, uint first_triangle, bvec4 met) {
    uvec4 count = mix(kind, uvec4(0u), equal(kind, uvec4(kBvhChildInner)));
    uvec4 end = uvec4(count.x, count.x + count.y, count.x + count.y + count.z, 0u);
    uvec4 bits = (uvec4(1u) << count) - 1u;
    bits = mix(uvec4(0u), uvec4(bits.x, bits.y << end.x, bits.z << end.y, bits.w << end.z), met);
    uint pending = bits.x | bits.y | bits.z | bits.w;
    while (pending != 0u) {
        uint lowest = pending & (~pending + 1u);
        pending ^= lowest;
        test_triangle(query, ray, first_triangle + (floatBitsToUint(float(int(lowest))) >> 23) - 127u);
        if (is_finished(query)) {
            break;
        }
    }
}

// Distances with slots in their lowest bits, ascending. Distances are not negative, so they sort as integers.
uvec4 sorted_children(vec4 entry, bvec4 met) {
    uvec4 key = mix(uvec4(kMissKey), (floatBitsToUint(entry) & ~3u) | uvec4(0u, 1u, 2u, 3u), met);
    uvec4 a = uvec4(min(key.x, key.y), max(key.x, key.y), min(key.z, key.w), max(key.z, key.w));
    uvec4 b = uvec4(min(a.x, a.z), min(a.y, a.w), max(a.x, a.z), max(a.y, a.w));
    return uvec4(b.x, min(b.y, b.z), max(b.y, b.z), b.w);
}

bool is_group(uint group) {
    return (group >> 30) != 0u;
}

void push_group(inout BvhCursor at, uint group, float t) {
    bvh_stack_[at.height] = group;
    bvh_stack_t_[at.height] = t;
    ++at.height;
}

// Goes to the nearest of the children in `key`; the others become the group.
void descend(inout BvhCursor at, uint first_child, uvec4 key) {
    at.node = first_child + (key.x & 3u);
    if (key.y != kMissKey) {
        if (is_group(at.group)) {
            push_group(at, at.group, at.group_t);
        }
        uint count = 1u + uint(key.z != kMissKey) + uint(key.w != kMissKey);
        at.group = first_child | (key.y & 3u) << 24 | (key.z & 3u) << 26 | (key.w & 3u) << 28 | count << 30;
        at.group_t = uintBitsToFloat(key.y & ~3u);
    }
}

// Goes to the next child of the group, or of the first group on the stack that is near enough. False if there is none.
bool take_next(inout BvhCursor at, inout BvhRay ray, vec3 origin, vec3 direction, float t_max) {
    bool is_found = is_group(at.group) && at.group_t < t_max;
    while (!is_found && at.height > 0) {
        --at.height;
        at.group = bvh_stack_[at.height];
        at.group_t = bvh_stack_t_[at.height];
        is_found = is_group(at.group) && at.group_t < t_max;
        if (kTwoLevel && !is_group(at.group)) {
            ray = make_bvh_ray(origin, direction, 0u);
        }
    }
    uint first_child = at.group & (kBvhMaxNodes - 1u);
    at.node = first_child + ((at.group >> 24) & 3u);
    at.group = first_child | ((at.group >> 26) & 15u) << 24 | ((at.group >> 30) - 1u) << 30;
    return is_found;
}

// Goes to the root of a placed level; the rest of the top level waits on the stack below a marker.
void enter_level(inout BvhCursor at, out BvhRay ray, vec3 origin, vec3 direction, uint placed) {
    if (is_group(at.group)) {
        push_group(at, at.group, at.group_t);
    }
    push_group(at, kNoGroup, 0.0);
    at.group = kNoGroup;
    int texel = int(placed * 4u);
    vec4 row0 = uintBitsToFloat(texelFetch(bvh_placed_levels_, texel));
    vec4 row1 = uintBitsToFloat(texelFetch(bvh_placed_levels_, texel + 1));
    vec4 row2 = uintBitsToFloat(texelFetch(bvh_placed_levels_, texel + 2));
    uvec4 tail = texelFetch(bvh_placed_levels_, texel + 3);
    at.node = tail.x;
    vec4 from = vec4(origin, 1.0);
    ray = make_bvh_ray(vec3(dot(row0, from), dot(row1, from), dot(row2, from)),
                       vec3(dot(row0.xyz, direction), dot(row1.xyz, direction), dot(row2.xyz, direction)), tail.y);
}

void traverse(inout BvhQuery query, vec3 origin, vec3 direction) {
    BvhCursor at = BvhCursor(0u, kNoGroup, 0.0, 0);
    BvhRay ray = make_bvh_ray(origin, direction, 0u);
    while (true) {
        int texel = int(at.node * 3u);
        uvec4 head = texelFetch(bvh_nodes_, texel);
        if (kTwoLevel && (head.w & kBvhPlaced) != 0u) {
            enter_level(at, ray, origin, direction, head.w & (kBvhPlaced - 1u));
            continue;
        }
        uvec4 planes = texelFetch(bvh_nodes_, texel + 1);
        uvec4 tail = texelFetch(bvh_nodes_, texel + 2);
        vec4 entry;
        bvec4 met = meet_children(head, planes, tail.xy, ray, query.t_min, query.hit.t, entry);
        uvec4 kind = child_kinds(head.w);
        test_leaves(query, ray, kind, tail.w, met);
        if (is_finished(query)) {
            break;
        }
        bvec4 is_inner = equal(kind, uvec4(kBvhChildInner));
        uvec4 key = sorted_children(entry, bvec4(uvec4(met) & uvec4(is_inner)));
        if (key.x != kMissKey) {
            descend(at, tail.z, key);
        } else if (!take_next(at, ray, origin, direction, query.hit.t)) {
            break;
        }
    }
}

Hit trace_closest(vec3 origin, vec3 direction, float t_min, float t_max, uint mode, uint seed) {
    BvhQuery query = BvhQuery(t_min, mode, seed, false, Hit(t_max, kNoInstance, 0u, vec2(0.0)), 1.0);
    traverse(query, origin, direction);
    return query.hit;
}

float trace_transmittance(vec3 origin, vec3 direction, float t_max) {
    BvhQuery query = BvhQuery(0.0, kTraceSolid, 0u, true, Hit(t_max, kNoInstance, 0u, vec2(0.0)), 1.0);
    traverse(query, origin, direction);
    return query.hit.instance != kNoInstance ? 0.0 : query.transmittance;
}
