// SPDX-License-Identifier: Apache-2.0
// The bodies' buffers, the scene's placements and materials (render/passes/scene_buffers.h), and the records that compute
// passes write for each frame.
#include "direction.glsl"
#define NO_FACE 0xffffffffu

struct Placement {
  vec3 offset;
  uint flags;  // PLACEMENT_...; from bit 8 on, what is added to the body's material indices
  vec4 cut;    // normal and offset in the picture's coordinates: dot(cut.xyz, x) > cut.w is removed; 0, 1 = nothing
};
#define PLACEMENT_HIDDEN 1u
#define PLACEMENT_SELECTED 2u
#define PLACEMENT_FAULTY 4u
#define PLACEMENT_SMOOTH 8u

// See render/body_data.h.
struct FaceRecord {
  uvec4 neighbors;
  uint material;
  uint shape;
};

layout(std430, binding = 1) readonly buffer Positions { float positions[]; };
#ifdef WRITES_PLACEMENTS
layout(std430, binding = 2) buffer Placements { Placement placements[]; };
#else
layout(std430, binding = 2) readonly buffer Placements { Placement placements[]; };
#endif
layout(std430, binding = 3) readonly buffer MassBodies { uint mass_bodies[]; };
layout(std430, binding = 4) readonly buffer FaceRecords { FaceRecord face_records[]; };
layout(std430, binding = 6) readonly buffer Materials { vec4 materials[]; };  // linear color, activation

vec4 material_at(uint material, uint placement_flags) {
  return materials[min(material + (placement_flags >> 8), uint(materials.length()) - 1u)];
}

vec3 position_of(uint mass) { return vec3(positions[3u * mass], positions[3u * mass + 1u], positions[3u * mass + 2u]); }
