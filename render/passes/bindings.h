// SPDX-License-Identifier: Apache-2.0
// Binding points of buffers and textures; shaders/ has the same numbers.
#pragma once

namespace mercury::render::binding {

// Storage buffers. A pass binds its own buffers from first_free on.
inline constexpr unsigned positions = 1, placements = 2, mass_bodies = 3, face_records = 4, seen_face_records = 5,
                          materials = 6, faces = 7, mass_normals = 8, face_values = 9, mass_values = 10,
                          first_free = 11, face_normals = 13, face_areas = 14, seen_faces = 15;

// Textures. 0 is the pass's own source.
inline constexpr unsigned source = 0, shadow_map = 1, shadow_depths = 2, occlusion = 3, caustics = 4, sand = 5,
                          ground_light = 6, colormap = 7, glow = 8, font = 9, section = 10, front_light = 11,
                          faces_seen = 12, prints = 13;

}  // namespace mercury::render::binding
