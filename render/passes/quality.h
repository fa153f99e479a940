// SPDX-License-Identifier: Apache-2.0
// The settings of each level of quality.
#pragma once

#include <string>

#include "render/renderer.h"

namespace mercury::render {

struct QualitySettings {
  int samples = 4;                           // per pixel
  int shadow_side = 1024;                    // texels
  int ground_side = 256;                     // texels of the floor's light map
  int caustics_side = 320;                   // texels of a tile
  int caustics_cells = 64;                   // of the grid of light rays that is drawn into it, per side
  int shadow_blockers = 5, shadow_taps = 8;  // of shadows on the floor
  int occlusion_taps = 7;
  int particles = 500;
  int skin_blockers = 0, skin_taps = 4;  // of shadows on skins
  int prints_side = 0;                   // texels of the map of prints in the ground; 0 = none
  int lens_samples = 32;                 // pictures of which one through a lens is the mean, at most
  bool front_light = false;              // shadows on skins: once per pixel, before skins are drawn
  std::string defines() const;           // for the shaders
  std::string skin_defines() const;      // for the shaders of bodies
};

// Not for Quality::automatic.
QualitySettings settings_of(Quality quality);

}  // namespace mercury::render
