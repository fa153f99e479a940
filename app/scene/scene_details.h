// SPDX-License-Identifier: Apache-2.0
// What a scene shows besides the robots' shapes: values to color by, and arrows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/arrows.h"
#include "app/scene/coloring.h"
#include "app/scene/touch_marks.h"
#include "app/scene/view_settings.h"
#include "mercury/simulation.h"

namespace mercury {

// Larger groups have no plants, carry no water, and their touch does not light up: drawing them takes the time.
constexpr std::size_t most_with_extras = 300;

struct SceneDetails {
  ColorValues values;
  std::vector<render::Arrow> arrows;
  std::string arrow_key;  // what their lengths mean
  DrivenMaterials driven;
  std::vector<TouchMark> touches;
};

// The settings without what the environment does not have: its color quantity becomes the material, its arrows go.
ViewSettings known_in(const ViewSettings& settings, const Environment& environment);

// Computes them on the simulating thread, so that this overlaps with drawing. Does not read positions and velocities
// when only shapes are shown, of robots that do not feel the ground.
class DetailObserver {
 public:
  // Throws InputError when the environment does not have a color quantity or kind of arrow.
  DetailObserver(const Simulation& simulation, const ViewSettings& settings);
  SceneDetails observe(std::span<const Telemetry> telemetry);
  // The quantity whose values observe() returns.
  const ColorQuantity& color() const { return coloring_ ? coloring_->quantity() : material_color(); }

 private:
  const Simulation& simulation_;
  std::optional<Coloring> coloring_;
  std::optional<Arrows> arrows_;
  std::optional<TouchObserver> touch_;
};

}  // namespace mercury
