// SPDX-License-Identifier: Apache-2.0
// What a scene shows besides the robots' shapes: values to color by, and arrows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/arrows.h"
#include "app/scene/coloring.h"
#include "app/scene/footprints.h"
#include "app/scene/touch_marks.h"
#include "app/scene/view_settings.h"
#include "mercury/simulation.h"

namespace mercury {

// Larger groups have no plants, carry no water, leave no footprints, and their touch does not light up: drawing them
// takes the time.
constexpr std::size_t most_with_extras = 300;

struct SceneDetails {
  ColorValues values;
  std::vector<render::Arrow> arrows;
  std::string arrow_key;  // what their lengths mean
  DrivenMaterials driven;
  std::vector<TouchMark> touches;
  std::vector<GroundContacts> contacts;  // now and at moments since the last details, in the order of time
};

// The settings without what the environment does not have: its color quantity becomes the material, its arrows go.
ViewSettings known_in(const ViewSettings& settings, const Environment& environment);

// Computes them on the simulating thread, so that this overlaps with drawing. Does not read positions and velocities
// when only shapes are shown, of robots that do not feel the ground and leave no footprints.
class DetailObserver {
 public:
  // Throws InputError when the environment does not have a color quantity or kind of arrow.
  DetailObserver(const Simulation& simulation, const ViewSettings& settings);
  SceneDetails observe(std::span<const Telemetry> telemetry);
  // The next step at which to look for footprints, also between two details: multiples of an interval, so that
  // footprints do not depend on where frames are. Nothing if there are none.
  std::optional<std::int64_t> next_look() const;
  // Looks for footprints, which the next details then have.
  void look(std::span<const Telemetry> telemetry);
  // The quantity whose values observe() returns.
  const ColorQuantity& color() const { return coloring_ ? coloring_->quantity() : material_color(); }

 private:
  std::vector<GroundContacts> contacts_with(std::span<const Vec3> positions, std::span<const Telemetry> telemetry);

  const Simulation& simulation_;
  std::optional<Coloring> coloring_;
  std::optional<Arrows> arrows_;
  std::optional<TouchObserver> touch_;
  std::optional<FootprintObserver> footprints_;
  std::int64_t looked_at_ = 0;            // the last step with a look
  std::vector<GroundContacts> contacts_;  // since the last details
};

}  // namespace mercury
