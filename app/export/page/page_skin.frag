// SPDX-License-Identifier: Apache-2.0
// A skin, as shaders/skin.frag draws it, without its passes of precomputed light.
// COLOR_BY: 0 materials, 1 activation of materials, 2 values of masses
#define SHADOW_BLOCKERS 6
#define SHADOW_TAPS 16
#include "frame.glsl"
#include "bevel.glsl"
#include "shading.glsl"
#include "shadow.glsl"
#include "caustics.glsl"
#include "occlusion.glsl"
#include "skin_light.glsl"
flat in vec4 along_u;
flat in vec4 along_v;
flat in uvec4 normals_around;
flat in uvec2 normal_and_shape;
flat in vec4 material;
in vec3 world;
in vec4 smooth_normal;
in float value;
uniform sampler2D colormap;
layout(location = 0) out vec4 color;

void main() {
  vec3 from_eye = world - frame.eye.xyz;
  float range = length(from_eye);
  vec3 to_eye = -from_eye / range;
  SeenFace face = SeenFace(along_u, along_v, normals_around, normal_and_shape.x, 0u, normal_and_shape.y, 0u);
  vec3 flat_normal = normal_of(face.normal);
  float seam;
  vec3 normal = beveled_normal(face, flat_normal, world, seam);
  if (smooth_normal.w > 0.5) {
    normal = smooth_normal.xyz;
    seam = 0.0;
  }
  normal = normalize(normal);
  if (dot(flat_normal, to_eye) < 0.0) {
    normal = -normal;
    flat_normal = -flat_normal;
  }

#if COLOR_BY == 0
  float activation = material.a;
  vec3 albedo = material.rgb * (1.0 + 0.25 * min(activation, 0.0));
#else
  float activation = 0.0;
  vec3 albedo = texture(colormap, vec2(COLOR_BY == 1 ? 0.5 + 0.5 * material.a : value, 0.5)).rgb;
#endif
  albedo *= 1.0 - 0.28 * seam;
  float facing = max(dot(normal, to_eye), 0.0);
#if COLOR_BY == 0
  albedo = under_skin(albedo, facing);
#endif

  vec3 key = vec3(0.0);
  if (dot(normal, frame.to_key.xyz) > -0.25) {
    key = frame.key_light.rgb * key_visibility(world, flat_normal, pixel_noise(gl_FragCoord.xy));
#if AROUND == AROUND_WATER
    key *= caustics_on_skin(surface_point(world), 0.0);
#endif
  }
  vec3 light = lit(Surface(albedo, normal, 0.42, 0.6), to_eye, key, open_sky(world, normal));
  light += light_through(world, normal, to_eye, albedo);
  vec3 glow = glow_inside(albedo, activation, facing);
  color = vec4(through_fog(light + glow, -to_eye, range), 1.0);
}
