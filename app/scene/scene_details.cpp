// SPDX-License-Identifier: Apache-2.0
#include "app/scene/scene_details.h"

#include <variant>

#include "mercury/observables.h"

namespace mercury {

ViewSettings known_in(const ViewSettings& settings, const Environment& environment) {
  ViewSettings known = settings;
  if (!known.color->exists_in(environment)) known.color = &material_color();
  if (!has_face_forces(environment)) known.shown.arrows.drag = known.shown.arrows.lift = false;
  if (!has_ground(environment)) known.shown.arrows.contact = false;
  return known;
}

DetailObserver::DetailObserver(const Simulation& simulation, const ViewSettings& settings) : simulation_(simulation) {
  if (settings.color->has_values()) coloring_.emplace(simulation, *settings.color);
  if (settings.shown.arrows.any()) arrows_.emplace(simulation, settings.shown.arrows);
  if (simulation.size() <= most_with_extras) touch_.emplace(simulation);
}

SceneDetails DetailObserver::observe(std::span<const Telemetry> telemetry) {
  SceneDetails details;
  if (!coloring_ && !arrows_) {
    details.driven = simulation_.driven_materials();
    if (touch_ && touch_->feels()) {
      std::vector<Vec3> positions(simulation_.mass_count());
      simulation_.read_positions(positions);
      details.touches = touch_->marks(positions, telemetry);
    }
    return details;
  }
  GroupState state = read_state(simulation_);
  if (touch_) details.touches = touch_->marks(state.positions, telemetry);
  if (coloring_) details.values = coloring_->values(state);
  if (arrows_) {
    details.arrows = arrows_->at(state, telemetry);
    details.arrow_key = arrows_->key();
  }
  details.driven = std::move(state.driven);
  return details;
}

}  // namespace mercury
