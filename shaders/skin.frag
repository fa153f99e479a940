// SPDX-License-Identifier: Apache-2.0
// A skin, colored by materials or values.
//
// COLOR_BY      0 materials, 1 face values, 2 mass values
// ROUNDED       some bodies are smooth
// MARKED        some bodies are faulty
// FRONT_LIGHT   front_light.comp has computed how much light arrives
// CUT           draws the backs of skins, in place of which the cut's plane shows
#include "frame.glsl"
#include "bodies.glsl"
#include "bevel.glsl"
#include "values.glsl"
#include "shading.glsl"
#ifdef FRONT_LIGHT
#include "front_light.glsl"
#else
#include "shadow.glsl"
#include "caustics.glsl"
#include "occlusion.glsl"
#endif
#include "skin_light.glsl"
#ifdef CUT
#include "cut.glsl"
#include "cut_map.glsl"
layout(binding = 10) uniform sampler2D section;  // colors of bodies' insides in the cut's plane
#endif
layout(std430, binding = 5) readonly buffer SeenFaces { SeenFace seen[]; };

layout(location = 0) in vec3 local;
layout(location = 1) in vec3 skin_point;
layout(location = 2) flat in uint flags;
#ifdef ROUNDED
layout(location = 3) in vec3 smooth_normal;
#if COLOR_BY == 0
layout(location = 7) in vec4 smooth_material;
#endif
#endif
#if COLOR_BY == 1
layout(std430, binding = 9) readonly buffer FaceValues { float face_values[]; };
#elif COLOR_BY == 2
layout(location = 4) in float mass_value;
#endif
#ifdef CUT
layout(location = 5) flat in vec4 cut;
layout(location = 6) flat in uint body_index;
#endif
#if COLOR_BY != 0
layout(binding = 7) uniform sampler2D colormap;
layout(location = 1) uniform vec4 value_scale;
#endif
layout(location = 0) out vec4 color;  // a = share of light that glows

#ifdef CUT
// How drawings show a section: its outline, and hatched, but where colors are values. A share of its color.
float drawn_section(ivec2 at, uint body) {
  int width = max(1, int(frame.screen.y / 420.0));
  for (int i = 0; i < 8; ++i) {
    float angle = 0.7853982 * float(i);
    if (!is_inside(at + ivec2(round(float(width) * vec2(cos(angle), sin(angle)))), body)) return 0.25;
  }
#if COLOR_BY == 0
  float spacing = frame.screen.y / 60.0, line = abs(fract(float(at.x + at.y) / spacing) - 0.5) * spacing;
  return 1.0 - 0.2 * (1.0 - smoothstep(0.5, 1.5, line - 0.04 * spacing));
#else
  return 1.0;
#endif
}
#endif

void main() {
  SeenFace face = seen[gl_PrimitiveID];
  vec3 world = skin_point;
#ifdef CUT
  if (!shows_inside(ivec2(gl_FragCoord.xy), body_index)) discard;
  // Computed from the pixel and not from the skin, so that all faces of a body in its cut share one plane.
  vec2 uv = gl_FragCoord.xy * frame.screen.zw;
  world = point_of_cut(cut, sight_through(uv));
  gl_FragDepth = depth_of(world);
#endif
  vec3 from_eye = world - frame.eye.xyz;
  float range = length(from_eye);
  vec3 to_eye = -from_eye / range;

  vec3 flat_normal = normal_of(face.normal);
#ifdef CUT
  vec2 stored = octahedral(cut.xyz);
#else
  vec2 stored = unpackSnorm2x16(face.normal);
#endif
  float seam;
  vec3 normal = beveled_normal(face, flat_normal, local, seam);
#ifdef ROUNDED
  if ((flags & PLACEMENT_SMOOTH) != 0u) {
    normal = smooth_normal;
    seam = 0.0;
  }
#endif
  normal = normalize(normal);
#ifdef CUT
  normal = flat_normal = cut.xyz;
  seam = 0.0;
#endif
  if (dot(flat_normal, to_eye) < 0.0) {
    normal = -normal;
    flat_normal = -flat_normal;
    stored = octahedral(flat_normal);
  }

#if COLOR_BY == 0
  vec4 material = material_at(face.material, flags);
#ifdef ROUNDED
  if ((flags & PLACEMENT_SMOOTH) != 0u) material = smooth_material;
#endif
  float activation = material.a;
  vec3 albedo = material.rgb * (1.0 + 0.25 * min(activation, 0.0));
#else
#if COLOR_BY == 1
  float value = face_values[face.face];
#else
  float value = mass_value;
#endif
  float activation = 0.0;
  vec3 albedo = textureLod(colormap, on_colormap(value, value_scale), 0.0).rgb;
#endif
#ifdef CUT
  vec4 inside = texelFetch(section, ivec2(gl_FragCoord.xy), 0);
  albedo = inside.rgb * (1.0 + 0.25 * min(inside.a, 0.0));
  activation = inside.a;
  albedo *= drawn_section(ivec2(gl_FragCoord.xy), body_index);
#endif
  albedo *= 1.0 - 0.28 * seam;
  float facing = max(dot(normal, to_eye), 0.0);
#if COLOR_BY == 0 && !defined(CUT)
  albedo = under_skin(albedo, facing);
#endif
#ifdef MARKED
  if ((flags & PLACEMENT_FAULTY) != 0u) albedo = vec3(0.25 + 0.1 * dot(albedo, vec3(0.3)));
#endif

  float depth = dot(from_eye, -vec3(frame.view[0].z, frame.view[1].z, frame.view[2].z));
  vec3 key = vec3(0.0);
#ifdef FRONT_LIGHT
  vec2 found = front_light(ivec2(gl_FragCoord.xy), depth, stored);
  float open = found.y;
  if (dot(normal, frame.to_key.xyz) > -0.25) key = frame.key_light.rgb * found.x;
#else
  float open = openness(gl_FragCoord.xy, depth);
  if (dot(normal, frame.to_key.xyz) > -0.25) {  // it turns toward the light
    key = frame.key_light.rgb * key_visibility(world, flat_normal, pixel_noise(gl_FragCoord.xy));
#if AROUND == AROUND_WATER
    key *= caustics_on_skin(surface_point(world), 0.0);
#endif
  }
#endif
  vec3 light = lit(Surface(albedo, normal, 0.42, 0.6), to_eye, key, open);
#ifndef CUT
  light += light_through(world, normal, to_eye, albedo);
#endif

  vec3 glow = glow_inside(albedo, activation, facing);
#ifdef MARKED
  if ((flags & PLACEMENT_FAULTY) != 0u) glow += pow(1.0 - abs(dot(normal, to_eye)), 2.5) * vec3(2.0, 0.15, 0.1);
#endif
  vec3 total = through_fog(light + glow, -to_eye, range);
  color = vec4(total, clamp(dot(glow, vec3(1.0)) / (dot(total, vec3(1.0)) + 1e-4), 0.0, 1.0));
}
