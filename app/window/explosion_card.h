// What a robot that has exploded is told with: where, when, and what can be done.
#pragma once

#include <deque>

#include "app/window/desk.h"

namespace mercury::window {

class ExplosionCard {
 public:
  // Takes note of new explosions; call once a frame.
  void follow(Desk& desk);
  // Over the lower left of the picture, while there is one to tell of.
  void draw(Desk& desk, ImVec2 low, ImVec2 high, float aspect);

 private:
  std::deque<Explosion> explosions_;
};

}  // namespace mercury::window
