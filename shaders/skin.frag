// A skin: colour by look, lit.
#include "frame.glsl"
#include "bodies.glsl"
layout(std430, binding = 5) readonly buffer FaceFrames { FaceFrame face_frames[]; };
layout(location = 0) in vec3 local;
layout(location = 1) in vec3 world;
layout(location = 2) flat in uint flags;
layout(location = 0) out vec4 color;

void main() {
  uint face = uint(gl_PrimitiveID);
  FaceRecord record = face_records[face];
  vec3 normal = face_frames[face].normal.xyz;
  vec4 look = looks[min(record.look, uint(looks.length()) - 1u)];
  vec3 to_eye = normalize(frame.eye.xyz - world);
  if (!gl_FrontFacing) normal = -normal;
  float key = max(0.0, (dot(normal, frame.to_key.xyz) + 0.25) / 1.25);
  vec3 light = key * frame.key_light.rgb + mix(frame.ground_light.rgb, frame.sky_light.rgb, 0.5 + 0.5 * normal.z);
  vec3 glow = look.rgb * max(look.a, 0.0) * max(look.a, 0.0);
  color = vec4(look.rgb * light * (1.0 + 0.25 * min(look.a, 0.0)) + glow, 1.0);
}
