// SPDX-License-Identifier: Apache-2.0
// A disc of ground whose texture and meter lines slide, with a rim.
#include "frame.glsl"
#include "caustics.glsl"
#include "floor.glsl"
#include "occlusion.glsl"
layout(location = 0) in vec2 on_disc;
layout(location = 1) in vec3 world;
layout(location = 2) flat in vec3 slide_and_radius;
layout(location = 0) out vec4 color;

void main() {
  vec2 pixel = max(fwidth(world.xy), vec2(1e-6));
  float from_rim = (1.0 - length(on_disc)) * slide_and_radius.z;  // [m]
  float blur = max(pixel.x, pixel.y);
  float inside = clamp(from_rim / blur + 0.5, 0.0, 1.0);
  vec3 from_eye = world - frame.eye.xyz;
  float steps = -(frame.view * vec4(world, 1.0)).z;
  vec2 slid = world.xy + slide_and_radius.xy;
  vec3 light;
  vec3 albedo = soil(slid, world.xy, key_on_floor(world.xy), openness(gl_FragCoord.xy, steps), light);
  float width = max(0.035 * slide_and_radius.z, 1.5 * blur);
  float rim = 1.0 - smoothstep(width - blur, width, from_rim);
  albedo = mix(albedo * 1.12, frame.line_color.rgb, max(meter_lines(slid, pixel), 0.7 * rim));
  float range = length(from_eye);
  color = vec4(through_fog(albedo * light, from_eye / range, range), inside);
}
