// SPDX-License-Identifier: Apache-2.0
// The list of environments in the Tune panel, and what it says about robots that are made for another one.
#pragma once

#include <cstdint>
#include <vector>

#include "app/window/panels/panel_context.h"

namespace mercury::window {

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

}  // namespace mercury::window
