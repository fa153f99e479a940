// SPDX-License-Identifier: Apache-2.0
// A face that is drawn. Coordinates u and v on it at this time: a point p in the body's coordinates has
// u = dot(p, along_u.xyz) + along_u.w and v likewise. The first corner has u = v = 0, the second u = 1, the third v = 1.
#define NO_NORMAL 0x80008000u  // packSnorm2x16 never gives it

struct SeenFace {
  vec4 along_u;
  vec4 along_v;
  uvec4 normals_around;  // packed normals of FaceRecord.neighbors; NO_NORMAL = none
  uint normal;           // packed
  uint material;
  uint shape_and_size;   // halves: FaceRecord.shape, how wide the face is in the picture [pixels], turned toward the eye
  uint face;
};
