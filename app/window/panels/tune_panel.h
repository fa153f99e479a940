// SPDX-License-Identifier: Apache-2.0
// Solver, environment and materials, as sliders that act at once.
#pragma once

#include <cstdint>
#include <vector>

#include "app/window/panels/panel.h"

namespace mercury::window {

// The part of the Tune panel that changes the materials of the selected robots, or of all.
class MaterialsSection {
 public:
  void draw(PanelContext& context);

 private:
  void draw_factors(PanelContext& context, const std::vector<RobotId>& robots);
  void draw_one(PanelContext& context, const std::vector<RobotId>& robots);

  MaterialScale scale_;
  int material_ = 1;
};

// The list of environments in the Tune panel, and what it says about robots that are made for another one.
class EnvironmentChoice {
 public:
  // Returns true when the user chose another environment, or a solver that suits it.
  bool draw(PanelContext& context, Configuration& configuration);

 private:
  // How many robots of the scene are made for land, and for water.
  struct Made {
    std::uint64_t revision = ~std::uint64_t{0};  // of the list of robots
    std::size_t for_land = 0, for_water = 0;
  };
  void count(const LiveScene& scene);
  bool draw_list(PanelContext& context, Configuration& configuration) const;
  static bool draw_parts(PanelContext& context, Environment& environment);
  bool draw_hint(PanelContext& context, Configuration& configuration) const;

  Made made_;
};

class TunePanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  EnvironmentChoice environment_;
  MaterialsSection materials_;
};

}  // namespace mercury::window
