// SPDX-License-Identifier: Apache-2.0
// Random robots: how they are made, and the button that makes them.
#pragma once

#include "app/window/picture/desk.h"

namespace mercury::window {

class RandomPanel {
 public:
  void draw(Desk& desk);
  // New random robots, as the panel is set.
  void generate(Desk& desk);
  // Of its rows [pixels].
  float height() const;

  Generation generation{.count = 6};

 private:
  void draw_voxel_options(Desk& desk);
  void draw_network_options(Desk& desk);

  bool replace_ = true;
};

}  // namespace mercury::window
