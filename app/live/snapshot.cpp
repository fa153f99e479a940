// SPDX-License-Identifier: Apache-2.0
#include "app/live/snapshot.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mercury {
namespace {

std::size_t mass_count(const LiveRobots& robots, std::size_t robot) {
  return robots.mass_offsets[robot + 1] - robots.mass_offsets[robot];
}

}  // namespace

std::span<const float> held_neurons(const LiveRobot& robot) {
  return robot.by_hand ? std::span<const float>(robot.by_hand->neurons) : std::span<const float>();
}

void clamp_neurons(Simulation& simulation, std::size_t robot, std::span<const float> before,
                   std::span<const float> now) {
  const auto value = [](std::span<const float> values, std::size_t i) {
    return i < values.size() && !std::isnan(values[i]) ? std::optional(values[i]) : std::nullopt;
  };
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i)
    if (value(before, i) != value(now, i)) simulation.clamp_neuron(robot, i, value(now, i));
}

std::vector<HeldDrive> held_drives(std::span<const LiveRobot> robots) {
  std::vector<HeldDrive> held;
  for (std::size_t i = 0; i < robots.size(); ++i)
    for (std::size_t a = 0; robots[i].by_hand && a < robots[i].by_hand->drives.size(); ++a)
      if (const float drive = robots[i].by_hand->drives[a]; !std::isnan(drive)) held.push_back({i, a, drive});
  return held;
}

Simulation simulation_of(std::span<const LiveRobot> live, const Configuration& configuration, const TrialStart& start) {
  std::vector<Robot> robots;
  for (const LiveRobot& robot : live) {
    robots.push_back(*robot.robot);
    robots.back().name = robot.name;
  }
  Simulation simulation(configuration, robots);
  for (std::size_t i = 0; i < live.size(); ++i)
    for (std::size_t id = 1; live[i].materials && id < live[i].materials->size(); ++id)
      simulation.set_material(i, static_cast<MaterialId>(id), (*live[i].materials)[id]);
  simulation.hold_drives(held_drives(live));
  for (std::size_t i = 0; i < live.size(); ++i) clamp_neurons(simulation, i, {}, held_neurons(live[i]));
  if (start.is_elsewhere()) begin_at(simulation, start);
  return simulation;
}

std::span<const Material> materials_of(const LiveRobot& robot) {
  return robot.materials ? std::span<const Material>(*robot.materials) : materials_of(*robot.robot);
}

std::optional<std::size_t> LiveRobots::index_of(RobotId id) const {
  if (!indices.empty()) {
    const auto index = indices.find(id);
    return index == indices.end() ? std::nullopt : std::optional(index->second);
  }
  const auto found = std::ranges::find(robots, id, &LiveRobot::id);
  return found == robots.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - robots.begin()));
}

std::span<const Vec3> Snapshot::positions_of(std::size_t robot) const {
  return positions.host(robots->mass_offsets[robot], mass_count(*robots, robot));
}
std::span<const Vec3> Snapshot::velocities_of(std::size_t robot) const {
  if (velocities.empty()) return {};
  return std::span(velocities).subspan(robots->mass_offsets[robot], mass_count(*robots, robot));
}

std::span<Vec3> SnapshotPositions::set_on_host(std::size_t masses) {
  device_.reset();
  on_host_ = true;
  host_parts_.clear();
  host_.resize(size_ = masses);
  return host_;
}

void SnapshotPositions::set_on_device(std::unique_ptr<PositionSnapshot> positions, std::size_t masses) {
  device_ = std::move(positions);
  on_host_ = false;
  host_parts_.clear();
  size_ = masses;
}

std::span<const Vec3> SnapshotPositions::host() const {
  const std::lock_guard lock(mutex_);
  if (!on_host_) {
    host_.resize(size_);
    device_->read(0, host_);
    on_host_ = true;
  }
  return host_;
}
std::span<const Vec3> SnapshotPositions::host(std::size_t first, std::size_t count) const {
  const std::lock_guard lock(mutex_);
  if (on_host_) return std::span(host_).subspan(first, count);
  std::vector<Vec3>& part = host_parts_[first];
  if (part.size() < count) {
    part.resize(count);
    device_->read(first, part);
  }
  return std::span(part).first(count);
}

}  // namespace mercury
