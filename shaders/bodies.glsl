// The bodies' buffers, as render/bodies.h fills them, and what is computed from them each frame.
#define NO_FACE 0xffffffffu

struct Placement {
  vec3 offset;
  uint flags;  // PLACEMENT_...
};
#define PLACEMENT_HIDDEN 1u
#define PLACEMENT_SELECTED 2u
#define PLACEMENT_FAULTY 4u
#define PLACEMENT_SMOOTH 8u

struct FaceRecord {
  uvec4 neighbours;
  uint look;
  uint shape;
};

// A face as it stands now, in its body's coordinates. A point p of it has u = dot(p - origin, along_u), v likewise.
struct FaceFrame {
  vec4 normal;   // w = area [m2]
  vec4 origin;   // w = 1 for half a quadrilateral, 0 for a triangle
  vec4 along_u;
  vec4 along_v;
};

layout(std430, binding = 1) readonly buffer Positions { float positions[]; };
layout(std430, binding = 2) readonly buffer Placements { Placement placements[]; };
layout(std430, binding = 3) readonly buffer MassBodies { uint mass_bodies[]; };
layout(std430, binding = 4) readonly buffer FaceRecords { FaceRecord face_records[]; };
layout(std430, binding = 6) readonly buffer Looks { vec4 looks[]; };  // linear colour, activation

vec3 position_of(uint mass) { return vec3(positions[3u * mass], positions[3u * mass + 1u], positions[3u * mass + 2u]); }
