// SPDX-License-Identifier: Apache-2.0
#include "app/scene/scene_details.h"

namespace mercury {

DetailObserver::DetailObserver(const Simulation& simulation, const ViewSettings& settings) : simulation_(simulation) {
  if (settings.color->has_values()) coloring_.emplace(simulation, *settings.color);
  if (settings.shown.arrows.any()) arrows_.emplace(simulation, settings.shown.arrows);
}

SceneDetails DetailObserver::observe(std::span<const Telemetry> telemetry) {
  if (!coloring_ && !arrows_) return {};
  const GroupState state = read_state(simulation_);
  SceneDetails details;
  if (coloring_) details.values = coloring_->values(state);
  if (arrows_) {
    details.arrows = arrows_->at(state, telemetry);
    details.arrow_key = arrows_->key();
  }
  return details;
}

}  // namespace mercury
