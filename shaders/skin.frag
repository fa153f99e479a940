// A skin: coloured by looks or numbers, its edges rounded off by light alone.
#include "frame.glsl"
#include "bodies.glsl"
#include "shadow.glsl"
#include "shading.glsl"
#include "caustics.glsl"
#include "occlusion.glsl"
layout(std430, binding = 5) readonly buffer FaceFrames { FaceFrame face_frames[]; };
layout(std430, binding = 9) readonly buffer FaceValues { float face_values[]; };
layout(binding = 7) uniform sampler2D colormap;

layout(location = 0) in vec3 local;
layout(location = 1) in vec3 world;
layout(location = 2) in vec3 smooth_normal;
layout(location = 3) in float mass_value;
layout(location = 4) flat in uint flags;
layout(location = 0) out vec4 color;  // a = share of light that glows

layout(location = 0) uniform int color_by;      // 0 looks, 1 face values, 2 mass values
layout(location = 1) uniform vec3 value_scale;

const float bevel = 0.11;  // of the shorter side

vec3 neighbour_normal(uint face, vec3 otherwise) { return face == NO_FACE ? otherwise : face_frames[face].normal.xyz; }

// The face's normal, blended with its neighbours' towards the edges so that both sides agree there.
vec3 beveled_normal(FaceRecord record, FaceFrame face, out float seam) {
  vec2 uv = vec2(dot(local - face.origin.xyz, face.along_u.xyz), dot(local - face.origin.xyz, face.along_v.xyz));
  vec2 height = 1.0 / vec2(length(face.along_u.xyz), length(face.along_v.xyz));
  vec4 off;  // distance from the edges of FaceRecord.neighbours [m]
  float size = min(height.x, height.y);
  if (face.origin.w > 0.5) {
    off = vec4(uv.x * height.x, (1.0 - uv.x) * height.x, uv.y * height.y, (1.0 - uv.y) * height.y);
  } else {
    float third = 1.0 / length(face.along_u.xyz + face.along_v.xyz);
    size = 0.6 * min(size, third);
    off = vec4((1.0 - uv.x - uv.y) * third, uv * height, 1e9);
  }
  // A fine groove between voxels shows how a flat side is stretched; it is gone before it is thinner than a pixel.
  float nearest = min(min(off.x, off.y), min(off.z, off.w));
  float pixel = fwidth(nearest) + 1e-6 * size;
  float groove = 0.022 * size;
  seam = face.origin.w * clamp(groove / pixel, 0.0, 1.0) * (1.0 - smoothstep(0.3 * groove, groove + 1.3 * pixel, nearest));
  vec4 near = 1.0 - smoothstep(0.0, bevel * size, off);
  vec3 sum = face.normal.xyz;
  for (int i = 0; i < 4; ++i)
    if (near[i] > 0.0) sum += near[i] * neighbour_normal(record.neighbours[i], face.normal.xyz);
  return sum;
}

void main() {
  uint face = uint(gl_PrimitiveID);
  FaceRecord record = face_records[face];
  FaceFrame face_frame = face_frames[face];
  vec4 look = looks[min(record.look, uint(looks.length()) - 1u)];
  vec3 from_eye = world - frame.eye.xyz;
  float range = length(from_eye);
  vec3 to_eye = -from_eye / range;

  float seam;
  vec3 normal = beveled_normal(record, face_frame, seam);
  if ((flags & PLACEMENT_SMOOTH) != 0u) {
    normal = smooth_normal;
    seam = 0.0;
  }
  normal = normalize(normal);
  vec3 flat_normal = face_frame.normal.xyz;
  if (dot(flat_normal, to_eye) < 0.0) {
    normal = -normal;
    flat_normal = -flat_normal;
  }

  float activation = 0.0;
  vec3 albedo = look.rgb;
  if (color_by == 0) {
    activation = look.a;
    albedo *= 1.0 + 0.25 * min(activation, 0.0);
  } else {
    float value = color_by == 1 ? face_values[face] : mass_value;
    albedo = textureLod(colormap, vec2(value * value_scale.x + value_scale.y, value_scale.z), 0.0).rgb;
  }
  albedo *= 1.0 - 0.28 * seam;
  if ((flags & PLACEMENT_FAULTY) != 0u) albedo = vec3(0.25 + 0.1 * dot(albedo, vec3(0.3)));

  float open = openness(gl_FragCoord.xy, dot(from_eye, -vec3(frame.view[0].z, frame.view[1].z, frame.view[2].z)));
  vec3 key = frame.key_light.rgb;
  if (dot(normal, frame.to_key.xyz) > -0.25) {
    key *= key_visibility(world, flat_normal, pixel_noise(gl_FragCoord.xy));
    if (frame.water.y > 0.0) key *= caustics(world, 1.0);
  } else {
    key = vec3(0.0);  // its own back is turned to the light
  }
  vec3 light = lit(Surface(albedo, normal, 0.42, 0.6), to_eye, key, open);

  float strength = max(activation, 0.0);
  vec3 glow = frame.key_light.w * strength * strength * albedo * (0.35 + 0.65 * albedo) * (0.35 + 0.65 * max(dot(normal, to_eye), 0.0));
  if ((flags & (PLACEMENT_SELECTED | PLACEMENT_FAULTY)) != 0u) {
    float rim = pow(1.0 - abs(dot(normal, to_eye)), 2.5);
    glow += rim * ((flags & PLACEMENT_FAULTY) != 0u ? vec3(2.0, 0.15, 0.1) : vec3(1.6, 1.3, 0.5));
  }
  vec3 total = through_fog(light + glow, -to_eye, range);
  color = vec4(total, clamp(dot(glow, vec3(1.0)) / (dot(total, vec3(1.0)) + 1e-4), 0.0, 1.0));
}
