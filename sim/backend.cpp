// SPDX-License-Identifier: Apache-2.0
// What a backend can do by its other functions alone.
#include "mercury/backend.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "mercury/state.h"
#include "sim/physics/brain_plan.h"
#include "sim/physics/points.h"

namespace mercury {

void Backend::set_environments(std::span<const std::size_t> robots, std::span<const Environment>) {
  if (!robots.empty()) throw std::logic_error("this backend has one environment for all robots");
}

namespace {

// The states of several robots, to restore them after the backend has loaded other robots.
class SavedStates {
 public:
  void save(const Backend& backend, std::size_t robot, std::size_t masses) {
    State& state = states_.emplace_back(State{std::vector<Vec3>(masses), std::vector<Vec3>(masses)});
    backend.read(robot, state.positions, state.velocities);
    statuses_.push_back(backend.status(robot));
  }
  // To the first robots of the backend.
  void restore(Backend& backend) const {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      backend.write(i, states_[i].positions, states_[i].velocities);
      backend.set_status(i, statuses_[i]);
    }
  }

 private:
  std::vector<State> states_;
  std::vector<RobotStatus> statuses_;
};

// The mean by mass, one value per mass of the robot.
void mean(const Robot& robot, const Vec3* values, float* out) {
  double x = 0, y = 0, z = 0, total = 0;
  for (std::size_t i = 0; i < robot.masses.size(); ++i) {
    const auto mass = static_cast<double>(mass_of(robot, i));
    x += mass * static_cast<double>(values[i].x);
    y += mass * static_cast<double>(values[i].y);
    z += mass * static_cast<double>(values[i].z);
    total += mass;
  }
  const double share = 1.0 / total;
  out[0] = static_cast<float>(x * share);
  out[1] = static_cast<float>(y * share);
  out[2] = static_cast<float>(z * share);
}

}  // namespace

BatchSettings Backend::settings() const {
  throw std::logic_error("a backend without Backend::settings() can neither add nor keep robots");
}

PackedBrains Backend::read_brains(bool) const { throw std::logic_error("no brains think in this backend"); }
BrainArrays Backend::share_brains() { throw std::logic_error("no brains think in this backend"); }

void Backend::add(std::span<const Robot* const> robots, std::size_t first_new) {
  BatchSettings now = settings();
  SavedStates saved;
  for (std::size_t i = 0; i < first_new; ++i) saved.save(*this, i, robots[i]->masses.size());
  load(robots, now.configuration);
  now.materials.resize(robots.size() * max_materials);
  for (std::size_t i = first_new; i < robots.size(); ++i)
    std::ranges::copy(materials_of(*robots[i]), std::span(now.materials).subspan(i * max_materials).begin());
  write_materials(now.materials);
  saved.restore(*this);
  set_perturbations(now.perturbations);
}

void Backend::keep(std::span<const Robot* const> robots, std::span<const std::size_t> indices) {
  const BatchSettings now = settings();
  SavedStates saved;
  std::vector<Material> materials;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    saved.save(*this, indices[i], robots[i]->masses.size());
    const auto table = std::span(now.materials).subspan(indices[i] * max_materials, max_materials);
    materials.insert(materials.end(), table.begin(), table.end());
  }
  load(robots, now.configuration);
  write_materials(materials);
  saved.restore(*this);
}

void Backend::put_at_rest(std::span<const Robot* const> robots, std::size_t first, std::span<const float> lifts) {
  for (std::size_t i = 0; i < lifts.size(); ++i) {
    std::vector<Vec3> positions = robots[i]->masses;
    for (Vec3& x : positions) x += Vec3{0, 0, lifts[i]};
    write(first + i, positions, start_velocities(*robots[i]));
    set_status(first + i, {});
  }
}

bool Backend::measure_inversion(std::span<const BodyCells* const> /*cells*/) { return false; }

void Backend::step_and_report(const Clock& clock, std::int64_t steps, std::int64_t every, bool from_now,
                              const VisitReports& visit) {
  std::vector<RobotStatus> present = statuses();
  std::vector<Telemetry> telemetry(present.size());
  Clock now = clock;
  const auto report_now = [&] {
    std::ranges::fill(telemetry, Telemetry{});
    report(now, telemetry, present);
    visit(telemetry, present);
  };
  if (from_now) report_now();
  while (now.step < clock.step + steps) {
    step(now, every);
    now.step += every;
    report_now();
  }
}

std::shared_ptr<void> Backend::allocate_shared(std::size_t bytes) const {
  constexpr std::align_val_t alignment{256};  // of the memory that DLPack's consumers expect
  void* const memory = ::operator new(bytes, alignment);
  std::memset(memory, 0, bytes);
  return {memory, [](void* data) { ::operator delete(data, alignment); }};
}

void Backend::copy_shared(void* to, const void* from, std::size_t bytes) const { std::memcpy(to, from, bytes); }

void Backend::publish(std::span<const Robot* const> robots, const PublishedArrays& arrays) const {
  std::size_t masses = 0;
  for (const Robot* robot : robots) masses += robot->masses.size();
  std::vector<Vec3> values(masses);
  const auto write_vectors = [&](float* per_mass, float* per_robot) {
    if (per_mass) std::memcpy(per_mass, values.data(), values.size() * sizeof(Vec3));
    const Vec3* first = values.data();
    for (std::size_t i = 0; per_robot && i < robots.size(); first += robots[i++]->masses.size())
      mean(*robots[i], first, per_robot + 3 * i);
  };
  if (arrays.positions || arrays.centers) {
    read_positions(values);
    write_vectors(arrays.positions, arrays.centers);
  }
  if (arrays.velocities || arrays.center_velocities) {
    read_velocities(values);
    write_vectors(arrays.velocities, arrays.center_velocities);
  }
  if (!arrays.exploded) return;
  std::ranges::transform(statuses(), arrays.exploded,
                         [](const RobotStatus& status) { return status.exploded_step >= 0; });
}

}  // namespace mercury
