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
}

SceneDetails DetailObserver::observe(std::span<const Telemetry> telemetry) {
  if (!coloring_ && !arrows_) return {.driven = simulation_.driven_materials()};
  GroupState state = read_state(simulation_);
  SceneDetails details;
  if (coloring_) details.values = coloring_->values(state);
  if (arrows_) {
    details.arrows = arrows_->at(state, telemetry);
    details.arrow_key = arrows_->key();
  }
  details.driven = std::move(state.driven);
  return details;
}

}  // namespace mercury
