#version 460
// SPDX-License-Identifier: Apache-2.0
// Marks pixels that have BLEND surfaces in front of solid ones.
layout(location = 1) out uint has_layers;

void main() {
    has_layers = 1u;
}
