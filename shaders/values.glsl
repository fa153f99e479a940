// SPDX-License-Identifier: Apache-2.0
// Colors of values: a texture with one color map per row, and a scale (set_scale() in render/passes/lattice_pass.h).

// The texture coordinates of a value. scale.w: 0 = linear, below 0 = logarithmic, above 0 = asinh(value / scale.w).
vec2 on_colormap(float value, vec4 scale) {
  if (scale.w > 0.0) value = asinh(value / scale.w);
  if (scale.w < 0.0) value = log(max(value, 1e-37));
  return vec2(value * scale.x + scale.y, scale.z);
}
