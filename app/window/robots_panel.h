// The robots of the scene: list, generation, changes, saving.
#pragma once

#include <string>

#include "app/window/desk.h"

namespace mercury::window {

class RobotsPanel {
 public:
  void draw(Desk& desk, float aspect);
  // New random robots, as the panel is set.
  void generate(Desk& desk);
  void mutate(Desk& desk);
  // Asks where to, for the selected robots, or all.
  static void save(Desk& desk);
  // Asks what, by name.
  static void open(Desk& desk);

  Generation generation{.count = 6};

 private:
  void draw_list(Desk& desk, float aspect);
  void draw_generation(Desk& desk);
  void draw_changes(Desk& desk);

  bool replace_ = true;
  Mutation mutation_;
  RobotId anchor_ = 0;  // where a range of selected rows begins
};

}  // namespace mercury::window
