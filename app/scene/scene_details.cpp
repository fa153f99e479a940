// SPDX-License-Identifier: Apache-2.0
#include "app/scene/scene_details.h"

#include <algorithm>
#include <utility>

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
  if (simulation.size() > most_with_extras) return;
  touch_.emplace(simulation);
  if (settings.footprints && settings.layout != Layout::race && has_ground(simulation.configuration().environment))
    footprints_.emplace(simulation);
  if (footprints_) looked_at_ = simulation.steps() - footprints_->interval();
}

std::optional<std::int64_t> DetailObserver::next_look() const {
  if (!footprints_) return std::nullopt;
  const std::int64_t interval = footprints_->interval();
  const std::int64_t first = std::max(looked_at_ + 1, simulation_.steps());
  return (first + interval - 1) / interval * interval;
}

void DetailObserver::look(std::span<const Telemetry> telemetry) {
  if (!footprints_) return;
  std::vector<Vec3> positions(simulation_.mass_count());
  simulation_.read_positions(positions);
  contacts_.push_back(footprints_->contacts(positions, telemetry));
  looked_at_ = simulation_.steps();
}

// Those that are known, and those of now if nobody has looked for so long.
std::vector<GroundContacts> DetailObserver::contacts_with(std::span<const Vec3> positions,
                                                          std::span<const Telemetry> telemetry) {
  std::vector<GroundContacts> all = std::exchange(contacts_, {});
  if (!footprints_) return all;
  const std::int64_t now = simulation_.steps();
  if (now >= looked_at_ && now < looked_at_ + footprints_->interval()) return all;
  all.push_back(footprints_->contacts(positions, telemetry));
  looked_at_ = now;
  return all;
}

SceneDetails DetailObserver::observe(std::span<const Telemetry> telemetry) {
  SceneDetails details;
  if (!coloring_ && !arrows_) {
    details.driven = simulation_.driven_materials();
    if (!footprints_ && !(touch_ && touch_->feels())) return details;
    std::vector<Vec3> positions(simulation_.mass_count());
    simulation_.read_positions(positions);
    if (touch_) details.touches = touch_->marks(positions, telemetry);
    details.contacts = contacts_with(positions, telemetry);
    return details;
  }
  GroupState state = read_state(simulation_);
  details.contacts = contacts_with(state.positions, telemetry);
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
