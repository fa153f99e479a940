// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/drives.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/cpu/layout/body.h"
#include "sim/physics/actuation.h"

namespace mercury::cpu {
namespace {

bool move_alike(const Material& a, const Material& b) {
  return a.amplitude == b.amplitude && a.frequency == b.frequency && a.phase == b.phase && a.half_wave == b.half_wave;
}

ActuatorSetting setting_of(const Drives& drives, std::size_t actuator) {
  const float drive = drives.drive[actuator];
  return {drives.amplitude[actuator], drives.frequency[actuator], drives.phase[actuator], drive,
          is_driven(drives.driven[actuator], drive)};
}

// With the sine that stands for the drive, so that this is computed once for all materials of an actuator.
ActuatorSetting as_sine(const ActuatorSetting& setting) {
  return {setting.amplitude, 0, arcsine(setting.drive), std::numeric_limits<float>::quiet_NaN(), false};
}

}  // namespace

void set_drives(Body& body, const ActuationSources& sources, std::size_t robot) {
  remove_drives(body);
  const std::size_t row = robot * sources.columns;
  body.drives = {sources.amplitude + row, sources.frequency + row, sources.phase + row,
                 sources.drive + row,     sources.driven + row,    {}};
  for (std::size_t id = 0; id < body.materials.size(); ++id) {
    const std::uint8_t actuator = sources.actuator_of[robot * max_materials + id];
    if (actuator == ActuationSources::no_actuator || !body.measures.used[id]) continue;
    body.drives.materials.push_back(
        {.id = static_cast<MaterialId>(id), .actuator = actuator, .own = body.materials[id]});
  }
  if (body.drives.materials.empty()) return;
  std::ranges::stable_sort(body.drives.materials, {}, &DrivenMaterial::actuator);
  if (!body.changed_materials.empty()) return;
  std::vector<Material> table(max_materials);
  std::ranges::copy(body.materials, table.begin());
  set_materials(body, table);
}

void remove_drives(Body& body) {
  for (const DrivenMaterial& driven : body.drives.materials) body.changed_materials[driven.id] = driven.own;
  body.drives = {};
}

void add_driven_factors(Body& body, Muscles& muscles) {
  std::vector<DrivenMaterial>& all = body.drives.materials;
  for (auto driven = all.begin(); driven != all.end(); ++driven) {
    const auto same = std::find_if(all.begin(), driven, [&](const DrivenMaterial& other) {
      return other.actuator == driven->actuator && move_alike(other.own, driven->own);
    });
    driven->factor = same == driven ? muscles.add_driven() : same->factor;
  }
}

bool read_drives(Body& body, Muscles& muscles) {
  const DrivenMaterial* previous = nullptr;
  ActuatorSetting setting{};
  bool by_drive = false, failed = false;
  for (const DrivenMaterial& driven : body.drives.materials) {
    if (!previous || previous->actuator != driven.actuator) {
      setting = setting_of(body.drives, driven.actuator);
      failed = failed || has_failed(setting);
      by_drive = setting.driven && std::isfinite(setting.drive);
      if (by_drive) setting = as_sine(setting);
    }
    Material& now = body.changed_materials[driven.id];
    now = actuated(driven.own, setting);
    if (by_drive) now.half_wave = false;  // as in actuated()
    muscles.drive(driven.factor, now);
    previous = &driven;
  }
  return !failed;
}

}  // namespace mercury::cpu
