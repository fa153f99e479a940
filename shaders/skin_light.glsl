// SPDX-License-Identifier: Apache-2.0
// Light inside soft bodies: a thin pale skin, the key light that shines through, contracting muscles that glow. Needs
// frame.glsl, and shadow_depths (shadow.glsl).
#ifndef SHADOW_DEPTHS_DECLARED
layout(binding = 2) uniform sampler2D shadow_depths;
#endif

// What is seen of a color below the skin: less at the edges, where the line of sight runs along within the skin.
// `facing`: cosine of the angle between normal and line of sight.
vec3 under_skin(vec3 albedo, float facing) {
  float edge = 1.0 - facing;
  return mix(albedo, vec3(0.62, 0.60, 0.58), 0.08 + 0.34 * edge * edge * edge);
}

// The key light that has come through a body, by the depth of the body between this point and the light: a translucent
// shadow map (Dachsbacher and Stamminger 2003).
vec3 light_through(vec3 point, vec3 normal, vec3 to_eye, vec3 albedo) {
  vec3 on_map = (frame.shadow * vec4(point, 1.0)).xyz;
  float n_l = dot(normal, frame.to_key.xyz);
  float thickness = max(on_map.z - textureLod(shadow_depths, on_map.xy, 0.0).r, 0.0) * frame.shadow_size.y;
  float depths = thickness / max(frame.lens.w, 1e-6);
  float left = 0.7 * exp(-depths) + 0.3 * exp(-0.2 * depths);
  float ahead = max(dot(-to_eye, frame.to_key.xyz), 0.0);
  float spread = (0.2 + 0.8 * ahead * ahead) * smoothstep(0.5, -0.3, n_l);
  return frame.key_light.rgb * albedo * (0.3 + 0.7 * albedo) * (left * spread);
}

// Muscles inside glow as they contract; the middle of a body shows more of them than its edge.
vec3 glow_inside(vec3 albedo, float activation, float facing) {
  float strength = max(activation, 0.0);
  return frame.key_light.w * strength * strength * albedo * (0.35 + 0.65 * albedo) * (0.25 + 0.75 * facing * sqrt(facing));
}
