// SPDX-License-Identifier: Apache-2.0
// Materials of a size class: tables, phases, and copies of the tables that actuators drive.

#include <algorithm>
#include <iterator>
#include <utility>

#include "mercury/parallel.h"
#include "sim/cuda/block_layout.h"
#include "sim/cuda/kernels.h"
#include "sim/cuda/size_class.h"
#include "sim/physics/face_backs.h"

namespace mercury::cuda {

void SizeClass::describe(std::uint32_t place, const Configuration& of_batch) {
  const Configuration configuration = configuration_of(place, of_batch);
  const Robot& robot = *robots_[place];
  const RobotMeasures& measures = measures_[place];
  const Environment& environment = configuration.environment;
  const bool own = has_own_points(robot, environment);
  point_properties_[place] = own ? point_properties(robot, environment) : std::vector<PointProperties>();
  const InertiaRange inertia = inertia_range(point_properties_[place]);
  RobotHeader& header = headers_[place];
  const float distance = contact_distance(robot, measures, environment);
  const float contact_stiffness = contact_stiffness_of(environment, configuration.solver, configuration.dt,
                                                       stiffest_spring(measures, table(place)), inertia.lightest);
  header.relaxation_time = common_relaxation_time(measures, table(place)).value_or(-1);
  header.highest_length_rate = highest_length_rate(measures, table(place));
  const FixedPointScale scale = fixed_point_scale(measures, table(place), configuration, distance, inertia);
  header.environment_scale = scale.environment;
  header.contact_distance = contact_stiffness > 0 ? distance : 0;
  header.contact_units = contact_stiffness * scale.environment;
  header.list_radius = list_radius(distance, measures.shortest);
  header.force_scale = scale.force;
  header.correction_scale = scale.correction;
}

bool SizeClass::has_real_bodies() const {
  return std::ranges::any_of(headers_, [](const RobotHeader& header) { return header.highest_length_rate > 0; }) ||
         std::ranges::any_of(robots_, [](const Robot* robot) { return has_own_points(*robot); });
}

void SizeClass::publish_points() {
  if (!std::exchange(points_stale_, false)) return;
  const bool own = std::ranges::any_of(point_properties_, [](const auto& points) { return !points.empty(); });
  points_ = {};
  point_masses_ = {};
  if (!own && !valences_have_masses_) return;
  const std::size_t stride = sizes_.slots();
  std::vector<PointProperties> points(size() * stride, PointProperties{0, 0});
  std::vector<float> masses(size() * stride), valences(size() * stride);
  parallel_for(0, size(), [&](std::size_t index) {
    const auto place = static_cast<std::uint32_t>(index);
    const Robot& robot = *robots_[place];
    const std::vector<std::uint32_t> springs = mercury::valences(robot);
    for (std::uint32_t mass = 0; mass < robot.masses.size(); ++mass) {
      const std::size_t slot = index * stride + order_of(place).slot_of(mass);
      points[slot] = point_properties_[place].empty() ? PointProperties{} : point_properties_[place][mass];
      masses[slot] = mass_of(robot, mass);
      valences[slot] = static_cast<float>(springs[mass]) * points[slot].inverse_inertia;
    }
  });
  const cudaStream_t stream = urgent_->get();
  valences_.write(0, valences, stream);
  valences_have_masses_ = own;
  if (!own) return;
  points_ = DeviceArray<PointProperties>(points.size());
  points_.write(0, points, stream);
  point_masses_ = DeviceArray<float>(masses.size());
  point_masses_.write(0, masses, stream);
}

void SizeClass::publish_backs(const Configuration& configuration) {
  face_backs_ = {};
  const auto is_one_sided = [&](std::size_t place) {
    const auto& own = environments_[place];
    return has_one_sided_water(own ? *own : configuration.environment);
  };
  bool needed = false;
  for (std::size_t place = 0; place < size(); ++place) needed = needed || is_one_sided(place);
  if (!needed || sizes_.face_pairs == 0) return;
  // The host keeps no order of face pairs, and this is rare.
  const std::size_t stride = sizes_.face_pairs;
  std::vector<FacePair> pairs(size() * stride);
  face_pairs_.read(0, pairs, urgent_->get());
  std::vector<std::uint32_t> backs(pairs.size());
  parallel_for(0, size(), [&](std::size_t place) {
    if (!is_one_sided(place)) return;
    fill_backs(std::span(backs).subspan(place * stride, stride), *robots_[place],
               order_of(static_cast<std::uint32_t>(place)).masses(), std::span(pairs).subspan(place * stride, stride),
               address_fields_);
  });
  face_backs_ = DeviceArray<std::uint32_t>(backs.size());
  face_backs_.write(0, backs, urgent_->get());
}

void SizeClass::find_same_materials(std::uint32_t first_changed) {
  same_materials_ = first_changed == 0 || same_materials_;
  for (std::uint32_t place = first_changed; same_materials_ && place < size(); ++place)
    same_materials_ = std::ranges::equal(table(place), table(0));
  phases_stale_ = true;
}

void SizeClass::publish_materials(std::uint32_t place, const Configuration& configuration) {
  lists_kept_ = false;
  describe(place, configuration);
  device_headers_.write(place, std::span(headers_).subspan(place, 1), urgent_->get());
  device_materials_.write(place, table(place), urgent_->get());
  if (driven_materials_.size() > 0)
    driven_materials_.write(std::size_t{place} * max_materials, driven_table(place), urgent_->get());
  find_same_materials(0);
}

void SizeClass::publish_all_materials(const Configuration& configuration) {
  configure(configuration);
  device_materials_.write(0, materials_, urgent_->get());
  for (std::uint32_t place = 0; driven_materials_.size() > 0 && place < size(); ++place)
    driven_materials_.write(std::size_t{place} * max_materials, driven_table(place), urgent_->get());
  find_same_materials(0);
}

void SizeClass::update_phases(const Clock& clock, cudaStream_t stream) {
  const bool same_base = clock.dt == phase_clock_.dt && clock.base_time == phase_clock_.base_time;
  if (size() == 0 || (!phases_stale_ && same_base)) return;
  compute_phases(view().materials, phases_.data(), swings_.data(), std::size_t{size()} * max_materials, clock, stream);
  phase_clock_ = clock;
  phases_stale_ = false;
}

void SizeClass::begin_actuation() {
  driven_ids_.assign(std::size_t{size()} * max_materials, air);
  std::vector<Material> tables;
  for (std::uint32_t place = 0; place < size(); ++place) {
    std::uint32_t count = 1;
    for (std::size_t id = 1; id < max_materials; ++id)
      if (measures_[place].used[id])
        driven_ids_[std::size_t{place} * max_materials + id] = static_cast<MaterialId>(count++);
    std::ranges::copy(driven_table(place), std::back_inserter(tables));
  }
  driven_materials_ = DeviceArray<Material>(tables.size());
  driven_materials_.write(0, tables, urgent_->get());
  rename_materials(driven_ids_);
  parts_stale_ = true;
  phases_stale_ = true;
}

void SizeClass::end_actuation() {
  if (driven_materials_.size() == 0) return;
  std::vector<MaterialId> ids(driven_ids_.size(), air);
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (const MaterialId driven = driven_ids_[i]; driven != air)
      ids[i / max_materials * max_materials + driven] = static_cast<MaterialId>(i % max_materials);
  rename_materials(ids);
  driven_materials_ = DeviceArray<Material>();
  driven_ids_.clear();
  parts_stale_ = true;
  phases_stale_ = true;
}

void SizeClass::rename_materials(std::span<const MaterialId> ids) {
  DeviceArray<MaterialId> on_device(ids.size());
  on_device.write(0, ids, urgent_->get());
  cuda::rename_materials(springs_.data(), size(), sizes_.springs() / sizes_.record_words, sizes_.record_words,
                         on_device.data(), urgent_->get());
  urgent_->synchronize();
}

std::uint32_t SizeClass::table_chunks() const {
  std::uint32_t named = 1;  // ids, from that of air on
  for (std::uint32_t place = 0; place < size(); ++place) {
    const auto& used = measures_[place].used;
    if (driven_materials_.size() > 0)
      named = std::max(named, 1 + static_cast<std::uint32_t>(std::ranges::count(used, true)));
    else
      named = static_cast<std::uint32_t>(std::find(used.rbegin(), used.rend() - named, true).base() - used.begin());
  }
  return divide_up(named, lanes);
}

std::vector<Material> SizeClass::driven_table(std::uint32_t place) const {
  std::vector<Material> driven{materials_[std::size_t{place} * max_materials]};
  for (std::size_t id = 1; id < max_materials; ++id)
    if (measures_[place].used[id]) driven.push_back(materials_[std::size_t{place} * max_materials + id]);
  driven.resize(max_materials);
  return driven;
}

DrivenMaterial SizeClass::driven_material(std::uint32_t place, MaterialId id, std::uint32_t setting) const {
  const std::size_t first = std::size_t{place} * max_materials, driven = first + driven_ids_[first + id];
  return {device_materials_.data() + first + id,
          driven_materials_.data() + driven,
          phases_.data() + driven,
          swings_.data() + driven,
          statuses_.data() + place,
          setting};
}

}  // namespace mercury::cuda
