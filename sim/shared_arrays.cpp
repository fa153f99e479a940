// SPDX-License-Identifier: Apache-2.0
// Arrays that a Simulation shares with programs: parts of the state, and what drives the actuators.
#include "sim/shared_arrays.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "mercury/simulation.h"
#include "sim/simulation_parts.h"

namespace mercury {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

template <class T>
SharedArray<T> allocate(const Backend& backend, std::size_t rows, std::size_t columns) {
  SharedArray<T> array{.rows = rows, .columns = columns, .cuda_device = backend.cuda_device()};
  if (const std::size_t size = rows * columns)
    array.data = std::static_pointer_cast<T>(backend.allocate_shared(size * sizeof(T)));
  return array;
}

template <class T>
std::vector<T> read(const Backend& backend, const SharedArray<T>& array) {
  std::vector<T> values(array.rows * array.columns);
  if (!values.empty()) backend.copy_shared(values.data(), array.data.get(), values.size() * sizeof(T));
  return values;
}

// A robot's materials as they are now; `table` = null: its own.
std::span<const Material> present_materials(const Robot& robot, const std::unique_ptr<MaterialTable>& table) {
  return table ? std::span<const Material>(*table) : materials_of(robot);
}

// What the materials of an actuator have in common, NaN where they differ.
ActuatorSetting common_setting(const Actuator& actuator, std::span<const Material> materials) {
  const Material& first = materials[actuator.materials.front()];
  ActuatorSetting common{first.amplitude, first.frequency, first.phase, none, false};
  for (const MaterialId id : actuator.materials) {
    if (materials[id].amplitude != first.amplitude) common.amplitude = none;
    if (materials[id].frequency != first.frequency) common.frequency = none;
    if (materials[id].phase != first.phase) common.phase = none;
  }
  return common;
}

constexpr SharedArray<float> Actuation::*fields[] = {&Actuation::amplitude, &Actuation::frequency, &Actuation::phase,
                                                     &Actuation::drive};

}  // namespace

SharedArray<float> SharedState::array(const Backend& backend, std::span<const Robot* const> robots,
                                      std::span<const std::size_t> mass_offsets, StateArray which) {
  SharedArray<float>& wanted = arrays_[static_cast<std::size_t>(which)];
  const bool per_mass = which == StateArray::positions || which == StateArray::velocities;
  const std::size_t rows = per_mass ? mass_offsets.back() : mass_offsets.size() - 1;
  if (!wanted.data || wanted.rows != rows) {
    wanted = allocate<float>(backend, rows, 3);
    publish(backend, robots);
  }
  return wanted;
}

SharedArray<std::uint8_t> SharedState::exploded(const Backend& backend, std::span<const Robot* const> robots) {
  if (!exploded_.data || exploded_.rows != robots.size()) {
    exploded_ = allocate<std::uint8_t>(backend, robots.size(), 1);
    publish(backend, robots);
  }
  return exploded_;
}

PublishedArrays SharedState::targets() const {
  return {.positions = arrays_[0].data.get(),
          .velocities = arrays_[1].data.get(),
          .centers = arrays_[2].data.get(),
          .center_velocities = arrays_[3].data.get(),
          .exploded = exploded_.data.get()};
}

void SharedState::publish(const Backend& backend, std::span<const Robot* const> robots) const {
  if (const PublishedArrays arrays = targets(); !arrays.empty()) backend.publish(robots, arrays);
}

void SharedState::forget() { *this = {}; }

const Actuation& SharedActuation::arrays(Backend& backend, std::span<const std::shared_ptr<const Robot>> robots,
                                         std::span<const std::unique_ptr<MaterialTable>> tables) {
  if (!made_) make(backend, robots, tables, {}, {}, {});
  return arrays_;
}

void SharedActuation::rearrange(Backend& backend, std::span<const std::shared_ptr<const Robot>> robots,
                                std::span<const std::unique_ptr<MaterialTable>> tables,
                                std::span<const std::size_t> kept) {
  if (!made_) return;
  std::vector<float> old;
  for (const auto field : fields) std::ranges::copy(read(backend, arrays_.*field), std::back_inserter(old));
  make(backend, robots, tables, old, read(backend, arrays_.driven), kept);
}

// `old` = the four arrays of numbers as they were, `old_driven` the other; `kept` = the old rows of the first robots.
void SharedActuation::make(Backend& backend, std::span<const std::shared_ptr<const Robot>> robots,
                           std::span<const std::unique_ptr<MaterialTable>> tables, std::span<const float> old,
                           std::span<const std::uint8_t> old_driven, std::span<const std::size_t> kept) {
  std::vector<std::vector<Actuator>> actuators;
  std::size_t columns = 0;
  for (const auto& robot : robots) {
    actuators.push_back(actuators_of(*robot));
    columns = std::max(columns, actuators.back().size());
  }
  counts_.clear();
  for (const auto& own : actuators) counts_.push_back(own.size());
  actuator_of_.assign(robots.size() * max_materials, ActuationSources::no_actuator);
  const std::size_t old_columns = arrays_.drive.columns, old_size = arrays_.drive.rows * old_columns;
  const std::size_t size = robots.size() * columns;
  std::vector<float> values(4 * size, none);
  std::vector<std::uint8_t> driven(size, 0);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::span<const Material> materials = present_materials(*robots[i], tables[i]);
    for (std::size_t a = 0; a < actuators[i].size(); ++a) {
      for (const MaterialId id : actuators[i][a].materials)
        actuator_of_[i * max_materials + id] = static_cast<std::uint8_t>(a);
      const ActuatorSetting common = common_setting(actuators[i][a], materials);
      const float initial[] = {common.amplitude, common.frequency, common.phase, common.drive};
      for (std::size_t field = 0; field < 4; ++field)
        values[field * size + i * columns + a] =
            i < kept.size() ? old[field * old_size + kept[i] * old_columns + a] : initial[field];
      if (i < kept.size()) driven[i * columns + a] = old_driven[kept[i] * old_columns + a];
    }
  }
  for (std::size_t field = 0; field < 4; ++field) {
    SharedArray<float>& array = arrays_.*fields[field];
    array = allocate<float>(backend, robots.size(), columns);
    if (size > 0) backend.copy_shared(array.data.get(), values.data() + field * size, size * sizeof(float));
  }
  arrays_.driven = allocate<std::uint8_t>(backend, robots.size(), columns);
  if (size > 0) backend.copy_shared(arrays_.driven.data.get(), driven.data(), size);
  made_ = true;
  applied_.assign(4 * size, 0);
  applied_driven_.assign(size, 0);
  attach(backend);
}

void SharedActuation::attach(Backend& backend) {
  if (!made_) return;
  applied_is_known_ = false;
  by_backend_ = backend.set_actuation({.amplitude = arrays_.amplitude.data.get(),
                                       .frequency = arrays_.frequency.data.get(),
                                       .phase = arrays_.phase.data.get(),
                                       .drive = arrays_.drive.data.get(),
                                       .driven = arrays_.driven.data.get(),
                                       .columns = arrays_.drive.columns,
                                       .actuator_of = actuator_of_});
}

void SharedActuation::set_drives(const Backend& backend, std::span<const DriveSetting> settings) {
  const SharedArray<float>& drive = arrays_.drive;
  if (settings.empty()) return;
  const auto write = [&](float* to, const std::uint8_t* driven) {
    for (const DriveSetting& setting : settings) {
      const std::size_t at = setting.robot * drive.columns + setting.actuator;
      if (driven[at] != held_drive) to[at] = setting.drive;
    }
  };
  if (drive.cuda_device < 0) return write(drive.data.get(), arrays_.driven.data.get());
  std::vector<float> values = read(backend, drive);
  write(values.data(), read(backend, arrays_.driven).data());
  backend.copy_shared(drive.data.get(), values.data(), values.size() * sizeof(float));
}

void SharedActuation::hold(const Backend& backend, std::span<const HeldDrive> held) {
  std::vector<float> drives = read(backend, arrays_.drive);
  std::vector<std::uint8_t> driven = read(backend, arrays_.driven);
  for (std::size_t at = 0; at < driven.size(); ++at) {
    if (driven[at] != held_drive) continue;
    drives[at] = none;
    driven[at] = 0;
  }
  for (const HeldDrive& one : held) {
    if (one.actuator >= counts_.at(one.robot)) throw std::out_of_range("the robot does not have this actuator");
    const std::size_t at = one.robot * arrays_.drive.columns + one.actuator;
    drives[at] = one.drive;
    driven[at] = held_drive;
  }
  if (driven.empty()) return;
  const std::vector<float> nothing(driven.size(), none);
  for (const auto field : fields) {
    const std::vector<float>& values = field == &Actuation::drive ? drives : nothing;
    backend.copy_shared((arrays_.*field).data.get(), values.data(), values.size() * sizeof(float));
  }
  backend.copy_shared(arrays_.driven.data.get(), driven.data(), driven.size());
}

struct DrivenMaterials::Arrays {
  std::size_t columns = 0;
  std::vector<ActuatorSetting> settings;  // [robot][columns]
  std::vector<std::uint8_t> actuator_of;  // ActuationSources::actuator_of
};

DrivenMaterials SharedActuation::driven_materials(const Backend& backend) const {
  DrivenMaterials now;
  if (!made_) return now;
  const auto amplitude = read(backend, arrays_.amplitude), frequency = read(backend, arrays_.frequency),
             phase = read(backend, arrays_.phase), drive = read(backend, arrays_.drive);
  std::vector<std::uint8_t> driven = read(backend, arrays_.driven);
  DrivenMaterials::Arrays arrays{.columns = arrays_.drive.columns, .settings = {}, .actuator_of = actuator_of_};
  arrays.settings.reserve(drive.size());
  for (std::size_t at = 0; at < drive.size(); ++at)
    arrays.settings.push_back({amplitude[at], frequency[at], phase[at], drive[at], is_driven(driven[at], drive[at])});
  now.arrays_ = std::make_shared<const DrivenMaterials::Arrays>(std::move(arrays));
  return now;
}

std::span<const ActuatorSetting> DrivenMaterials::settings(std::size_t robot) const {
  if (!arrays_ || (robot + 1) * arrays_->columns > arrays_->settings.size()) return {};
  return std::span(arrays_->settings).subspan(robot * arrays_->columns, arrays_->columns);
}

bool DrivenMaterials::drives(std::size_t robot) const {
  return std::ranges::any_of(settings(robot), &ActuatorSetting::driven);
}

std::vector<Material> DrivenMaterials::of(std::size_t robot, std::span<const Material> own) const {
  std::vector<Material> table(own.begin(), own.end());
  const std::span<const ActuatorSetting> all = settings(robot);
  if (all.empty()) return table;
  const auto actuators = std::span(arrays_->actuator_of).subspan(robot * max_materials, max_materials);
  for (std::size_t id = 0; id < std::min<std::size_t>(table.size(), max_materials); ++id) {
    if (actuators[id] == ActuationSources::no_actuator) continue;
    table[id] = actuated(table[id], all[actuators[id]]);
  }
  return table;
}

ActuatorSetting SharedActuation::setting(std::size_t at) const {
  const float drive = arrays_.drive.data.get()[at];
  return {arrays_.amplitude.data.get()[at], arrays_.frequency.data.get()[at], arrays_.phase.data.get()[at], drive,
          is_driven(arrays_.driven.data.get()[at], drive)};
}

// Robots are written whose settings are not, bit for bit, those of the last step.
void SharedActuation::apply(Backend& backend, std::int64_t step, std::span<const std::shared_ptr<const Robot>> robots,
                            std::span<const std::unique_ptr<MaterialTable>> tables) {
  if (!made_ || by_backend_) return;
  const std::size_t columns = arrays_.drive.columns, size = robots.size() * columns;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    bool same = applied_is_known_, failed = false;
    for (std::size_t at = i * columns; at < i * columns + counts_[i]; ++at) {
      const ActuatorSetting now = setting(at);
      failed = failed || has_failed(now);
      same = same && (applied_driven_[at] != 0) == now.driven;
      applied_driven_[at] = now.driven;
    }
    if (failed && backend.status(i).exploded_step < 0) backend.set_status(i, {.exploded_step = step});
    for (std::size_t field = 0; field < 4; ++field) {
      const float* const row = (arrays_.*fields[field]).data.get() + i * columns;
      std::uint32_t* const applied = applied_.data() + field * size + i * columns;
      for (std::size_t a = 0; a < columns; ++a) {
        const auto bits = std::bit_cast<std::uint32_t>(row[a]);
        same = same && applied[a] == bits;
        applied[a] = bits;
      }
    }
    if (same) continue;
    MaterialTable table{};
    std::ranges::copy(present_materials(*robots[i], tables[i]), table.begin());
    for (std::size_t id = 0; id < max_materials; ++id) {
      const std::size_t a = actuator_of_[i * max_materials + id];
      if (a == ActuationSources::no_actuator) continue;
      table[id] = actuated(table[id], setting(i * columns + a));
    }
    backend.write_materials(i, table);
  }
  applied_is_known_ = true;
}

SharedArray<float> Simulation::shared_state(StateArray which) {
  return parts_->shared_state.array(*parts_->backend, parts_->pointers, parts_->offsets, which);
}
SharedArray<std::uint8_t> Simulation::shared_exploded() {
  return parts_->shared_state.exploded(*parts_->backend, parts_->pointers);
}
const Actuation& Simulation::actuation() {
  return parts_->shared_actuation.arrays(*parts_->backend, parts_->robots, parts_->changed_tables);
}

void Simulation::hold_drives(std::span<const HeldDrive> held) {
  if (held.empty() && !parts_->shared_actuation.is_made()) return;
  (void)actuation();
  parts_->shared_actuation.hold(*parts_->backend, held);
}

DrivenMaterials Simulation::driven_materials() const {
  return parts_->shared_actuation.driven_materials(*parts_->backend);
}

}  // namespace mercury
