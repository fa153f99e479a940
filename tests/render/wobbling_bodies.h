// SPDX-License-Identifier: Apache-2.0
// Bodies to draw without a simulator: blobs of voxels that swim in place.
#pragma once

#include <cstdint>
#include <vector>

#include "render/scene.h"

namespace mercury::render {

struct WobblingBody {
  std::vector<float> rest;
  std::vector<std::uint32_t> faces, springs, face_materials, spring_materials;

  Body body() const { return {rest, faces, springs, face_materials, spring_materials}; }
  // The positions at a time [s]: traveling waves stretch and bend the body.
  std::vector<float> positions(double time, float phase) const;
};

// A random blob in a grid of side^3 voxels of 0.1 m, centered on the origin; each voxel has one of 22 materials.
WobblingBody make_wobbling_body(int side, std::uint32_t seed);

// A bumpy ball of about half a meter, made of triangles: an icosahedron whose sides are split into 4, `splits` times.
WobblingBody make_blob(int splits, std::uint32_t seed);

// The 22 materials: muscles with their activation at that time, tissue, bone.
std::vector<RenderMaterial> wobbling_materials(double time);

// `count` bodies and their placements, in rows that fill a picture of that aspect.
struct WobblingGroup {
  std::vector<WobblingBody> bodies;
  std::vector<Placement> placements;

  std::vector<Body> views() const;
  std::vector<float> positions(double time) const;
};
// side 0 = blobs instead of voxels.
WobblingGroup make_wobbling_group(int count, int side, std::uint32_t seed, float spacing);

}  // namespace mercury::render
