// SPDX-License-Identifier: Apache-2.0
// Draws a quad: text from signed distances with an outline, a box with round corners, or a scale of colors.
struct Quad {
  vec4 rectangle;
  vec4 source;
  vec4 color;
  vec4 edge;
  uint kind;
  float sharpness;
  uint map;
  uint padding;
};
layout(std430, binding = 11) readonly buffer Quads { Quad quads[]; };
layout(binding = 0) uniform sampler2D atlas;
layout(binding = 1) uniform sampler2D colormaps;  // one per row

layout(location = 0) in vec2 at;
layout(location = 1) flat in uint index;
layout(location = 0) out vec4 color;

void main() {
  Quad quad = quads[index];
  if (quad.kind == 0u) {
    // Pixels inside the outline.
    float inside = (textureLod(atlas, at / vec2(textureSize(atlas, 0)), 0.0).r - 128.0 / 255.0) * quad.sharpness;
    // Dark text on light looks thinner than light on dark, because blending is linear in light: make it bolder.
    inside += 0.25 * (1.0 - step(0.1, quad.color.g));
    float fill = clamp(inside + 0.5, 0.0, 1.0);
    float rim = clamp(inside + 2.0, 0.0, 1.0) * quad.edge.a;
    float opacity = mix(rim, quad.color.a, fill);
    color = vec4(mix(quad.edge.rgb, quad.color.rgb, fill), opacity);
  } else if (quad.kind == 1u) {
    vec2 half_size = 0.5 * quad.rectangle.zw;
    vec2 off = abs(at - 0.5) * quad.rectangle.zw - half_size + quad.source.x;
    float outside = length(max(off, vec2(0.0))) + min(max(off.x, off.y), 0.0) - quad.source.x;
    color = vec4(quad.color.rgb, quad.color.a * clamp(0.5 - outside, 0.0, 1.0));
  } else {
    float entries = float(textureSize(colormaps, 0).x);
    float value = ((1.0 - at.y) * (entries - 1.0) + 0.5) / entries;
    color = vec4(texture(colormaps, vec2(value, (float(quad.map) + 0.5) / float(textureSize(colormaps, 0).y))).rgb, 1.0);
  }
}
