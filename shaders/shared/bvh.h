// SPDX-License-Identifier: Apache-2.0
// Our own acceleration structure as the kernels see it: uniform texel buffers of RGBA32UI texels.
//
//   kBindNodes          BvhNode        4-wide nodes; node 0 is the root. In two-level trees the first
//                                      Bvh::top_capacity() nodes are the top level.
//   kBindLeafTriangles  LeafTriangle   triangles of the leaves, in the space of their bottom level
//   kBindTopLevel       PlacedLevel    bottom levels placed in the world: leaves of the top level
//
// A node's boxes are stored in 8 bits per plane on a grid of its own, rounded outwards, because the number of texel
// fetches decides the speed on software Vulkan (three per node instead of seven with floats).
// After: H. Ylitie, T. Karras, S. Laine. Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs.
// HPG 2017, section 3. Differs: four children, 48 bytes, children sorted by distance instead of by octant.
#ifndef FIELDCAST_SHARED_BVH_H
#define FIELDCAST_SHARED_BVH_H
#include "types.h"

SHARED_BEGIN

const uint kBvhWidth = 4u;
const uint kBvhMaxLeafSize = 4u;
const uint kBvhChildInner = 5u;     // kind of a child; smaller kinds are leaves with as many triangles (0: unused)
const uint kBvhKindBits = 3u;       // per child, from kBvhKindShift on
const uint kBvhKindShift = 18u;
const uint kBvhExponentBits = 6u;   // per axis, from bit 0 on
const uint kBvhExponentBias = 34u;  // cell size = 2^(exponent − bias) metres
const uint kBvhPlaced = 1u << 30;   // shape of a node without children: kBvhPlaced | index in kBindTopLevel
const uint kBvhStackSize = 64u;     // deepest tree that can be traversed, both levels together
const uint kBvhMaxNodes = 1u << 24; // a stack entry holds 24 bits of node index

struct BvhNode {
    vec3 origin;         // lower corner of the grid
    uint shape;          // 3 exponents, 4 kinds; or kBvhPlaced | index
    uint low_x;          // lower and upper planes in cells, 8 bits per child
    uint high_x;
    uint low_y;
    uint high_y;
    uint low_z;
    uint high_z;
    uint first_child;    // the inner children lie one after the other, in slot order
    uint first_triangle; // and so do the triangles of the leaf children (top level: the placed levels)
};

struct LeafTriangle {
    vec3 vertex;
    uint instance;       // plus PlacedLevel::first_instance
    vec3 edge1;          // to vertex 1
    uint primitive;
    vec3 edge2;          // to vertex 2
    uint flags;          // kMaterialAlphaMask, kMaterialDoubleSided of shared/scene.h
};

struct PlacedLevel {
    vec4 level_from_world[3]; // rows
    uint root;           // index of a node
    uint first_instance;
    uint unused0;
    uint unused1;
};

// Specialisation constants of kernels that trace rays.
const uint kSpecialiseAlpha = 100u;    // bool: some material is MASK or BLEND
const uint kSpecialiseTwoLevel = 102u; // bool: the BVH has a top level

// Ray query: alpha mode of an instance's material in its custom index, above the index of the instance.
const uint kRayQueryAlphaShift = 20u;

SHARED_END
#endif
