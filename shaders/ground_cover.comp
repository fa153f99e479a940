// SPDX-License-Identifier: Apache-2.0
// Places plants and stones on the floor: at most one per cell of a grid that is fixed in the world, in groups, as a number per
// cell says. render/passes/ground_cover_pass.h explains the stages.
#include "frame.glsl"
#include "bodies.glsl"
#include "ground_cover.glsl"
struct Box {
  vec4 low, high;
};
struct Patch {
  vec4 disc;   // center x, y; radius
  vec4 slide;
};
layout(std430, binding = 11) readonly buffer Boxes { Box boxes[]; };  // of the bodies, in their own coordinates
layout(std430, binding = 12) readonly buffer Patches { Patch patches[]; };
layout(std430, binding = 13) buffer Items { Item items[]; };  // one per cell
layout(std430, binding = 14) buffer Lists { uint lists[]; };  // plants, then stones
layout(std430, binding = 15) buffer Commands { uint commands[20]; };  // DrawElementsIndirectCommand, four times
layout(location = 0) uniform uint bodies;
layout(location = 1) uniform uint patch_count;
layout(location = 2) uniform vec4 sizes;    // side of a cell of level 0, tallest plant, highest stone [m]; share of plants
layout(location = 3) uniform vec4 clear;    // rectangle that stays bare: low x, y, high x, y [m]
layout(location = 4) uniform vec4 middle;   // of the grid: x, y [m]; where plants end, from there [m]; share of stones
layout(location = 5) uniform vec2 level;    // of the cells, and how much of those is shown that the next level leaves out
layout(location = 6) uniform uvec4 corners;   // of triangles per plant and per stone, and where each begins in the list of indices

const int cells = CELLS;  // per side

#if STAGE == 0
layout(local_size_x = 64) in;

uint mixed(uint n) {
  n = (n ^ 61u) ^ (n >> 16u);
  n *= 9u;
  n ^= n >> 4u;
  n *= 0x27d4eb2du;
  return n ^ (n >> 15u);
}
uint hashed(ivec2 cell, uint salt) { return mixed(uint(cell.x) * 1973u + mixed(uint(cell.y) * 9277u + salt * 26699u)); }
float number(ivec2 cell, uint salt) { return float(hashed(cell, salt) & 0xffffffu) / 16777216.0; }

// Smooth noise with one value per unit, for groups.
float noise(vec2 p, uint salt) {
  ivec2 cell = ivec2(floor(p));
  vec2 f = smoothstep(0.0, 1.0, p - vec2(cell));
  return mix(mix(number(cell, salt), number(cell + ivec2(1, 0), salt), f.x),
             mix(number(cell + ivec2(0, 1), salt), number(cell + ivec2(1, 1), salt), f.x), f.y);
}

// The cell of the next finer level that stands for this one.
ivec2 child_of(ivec2 cell, int of_level) {
  uint which = hashed(cell, 77u + uint(of_level)) >> 7u;
  return 2 * cell + ivec2(int(which & 1u), int((which >> 1u) & 1u));
}

// How tall something may be that would stand between the eye and a box: below the line of sight to its lowest point, or
// no taller than it is far from there.
float room_in_front(vec2 point, vec3 low, vec3 high) {
  vec2 to_body = 0.5 * (low.xy + high.xy) - frame.eye.xy, to_point = point - frame.eye.xy;
  float range = length(to_body), radius = 0.5 * length(high.xy - low.xy);
  vec2 ahead = to_body / max(range, 1e-6);
  float along = dot(to_point, ahead), aside = abs(ahead.x * to_point.y - ahead.y * to_point.x);
  if (along <= 0.0 || along >= range) return 1e30;
  float share = min(along / max(range - radius, 1e-6), 1.0);
  float line = mix(frame.eye.z, low.z, share) - frame.ground.w;
  return max(line, 0.0) + max(aside - radius * share, 0.0);
}

// How tall something may be at a point: below bodies it leaves most of the room, beside them it is no taller than its
// distance, and it hides none.
float room_at(vec2 point) {
  float margin = 0.15 * sizes.y;
  float room = 1e30;
  for (uint i = 0u; i < bodies; ++i) {
    Placement placement = placements[i];
    if ((placement.flags & PLACEMENT_HIDDEN) != 0u || boxes[i].low.x > boxes[i].high.x) continue;
    vec3 low = boxes[i].low.xyz + placement.offset, high = boxes[i].high.xyz + placement.offset;
    vec2 off = max(max(low.xy - point, point - high.xy), vec2(0.0));
    room = min(room, 0.6 * max(low.z - frame.ground.w, 0.0) + max(length(off) - margin, 0.0));
    room = min(room, room_in_front(point, low, high));
  }
  for (uint i = 0u; i < patch_count; ++i)
    room = min(room, max(distance(patches[i].disc.xy, point) - patches[i].disc.z - margin, 0.0));
  vec2 off = max(max(clear.xy - point, point - clear.zw), vec2(0.0));
  return min(room, max(length(off) - margin, 0.0));
}

Item item_of(ivec2 cell) {
  int own_level = int(level.x);
  float side = sizes.x * exp2(level.x);
  // Those that the next coarser level leaves out shrink before it takes over.
  ivec2 parent = ivec2(floor(vec2(cell) * 0.5));
  float share = child_of(parent, own_level + 1) == cell ? 1.0 : level.y;
  ivec2 base = cell;
  for (int i = own_level; i > 0; --i) base = child_of(base, i);
  Item item;
  item.turn = 6.2831853 * number(base, 3u);
  item.phase = number(base, 4u);
  vec2 point = (vec2(base) + 0.1 + 0.8 * vec2(number(base, 1u), number(base, 2u))) * sizes.x;
  item.foot = vec3(point, frame.ground.w);
  item.unused = 0.0;
  // Plants stand in groups, and stones in others.
  float group = noise(point / (5.0 * sizes.x), 5u) * 0.65 + noise(point / (2.1 * sizes.x), 6u) * 0.35;
  float stones = noise(point / (3.4 * sizes.x) + 31.7, 7u);
  float chance = number(base, 8u);
  bool plant = chance < sizes.w * smoothstep(0.42, 0.72, group);
  bool stone = !plant && number(base, 9u) < middle.w * (smoothstep(0.45, 0.85, stones) + 0.06);
  item.kind = stone ? ITEM_STONE : ITEM_PLANT;
  float own = number(base, 10u);
  float height = plant   ? sizes.y * (0.45 + 0.55 * own) * (0.55 + 0.45 * smoothstep(0.42, 0.8, group))
                 : stone ? sizes.z * (0.25 + 0.75 * own * own)
                         : 0.0;
  height *= share * (1.0 - smoothstep(0.6, 1.0, distance(point, middle.xy) / middle.z));
  // Nothing stands between the eye and what it looks at.
  height *= smoothstep(0.40, 0.75, distance(item.foot, frame.eye.xyz) / frame.water.w);
  float tallest = plant ? sizes.y : sizes.z;
  item.height = min(height, room_at(point));
  if (item.height < 0.12 * tallest) item.height = 0.0;
  return item;
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(cells * cells)) return;
  ivec2 first = ivec2(floor(middle.xy / (sizes.x * exp2(level.x)))) - cells / 2;
  items[index] = item_of(first + ivec2(int(index) % cells, int(index) / cells));
}
#else
layout(local_size_x = 256) in;

shared uvec2 sums[256];

void main() {
  uint lane = gl_LocalInvocationID.x;
  const uint per_lane = uint(cells * cells) / 256u;
  uvec2 own = uvec2(0u);
  for (uint i = 0u; i < per_lane; ++i) {
    Item item = items[lane * per_lane + i];
    if (item.height > 0.0) own += item.kind == ITEM_PLANT ? uvec2(1u, 0u) : uvec2(0u, 1u);
  }
  sums[lane] = own;
  for (uint step = 1u; step < 256u; step *= 2u) {
    barrier();
    uvec2 before = lane >= step ? sums[lane - step] : uvec2(0u);
    barrier();
    sums[lane] += before;
  }
  barrier();
  uvec2 at = sums[lane] - own;
  for (uint i = 0u; i < per_lane; ++i) {
    uint index = lane * per_lane + i;
    Item item = items[index];
    if (!(item.height > 0.0)) continue;
    if (item.kind == ITEM_PLANT)
      lists[at.x++] = index;
    else
      lists[uint(cells * cells) + at.y++] = index;
  }
  if (lane != 255u) return;
  uvec2 all = sums[255];
  // The plants and the stones, then the shade below each, which has no indices.
  for (uint i = 0u; i < 4u; ++i) {
    commands[5u * i] = i < 2u ? corners[i] : 6u;
    commands[5u * i + 1u] = i % 2u == 0u ? all.x : all.y;
    commands[5u * i + 2u] = i < 2u ? corners[i + 2u] : 0u;
    commands[5u * i + 3u] = commands[5u * i + 4u] = 0u;
  }
}
#endif
