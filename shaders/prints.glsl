// SPDX-License-Identifier: Apache-2.0
// What the map of prints in the ground covers: PlaceRecord of render/passes/print_pass.cpp.
layout(std140, binding = 1) uniform PrintPlace {
  vec4 map;  // corner x, y; side; depth of a fresh print [m]
} prints;

// Slopes up to 2.5 in bytes, of which 128 is level.
vec2 stored_slope(vec2 slope) { return (slope * 51.0 + 128.0) / 255.0; }
vec2 slope_of(vec2 stored) { return (stored * 255.0 - 128.0) / 51.0; }
