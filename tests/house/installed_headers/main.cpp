// SPDX-License-Identifier: Apache-2.0
// A program that has only the installed headers and libraries. Exit status 0 if they do what the headers say.
#include <algorithm>
#include <memory>
#include <vector>

#include <mercury/backend.h>
#include <mercury/objective.h>
#include <mercury/observables.h>
#include <mercury/quantity.h>
#include <mercury/simulation.h>
#include <mercury/voxel.h>

using namespace mercury;

// A backend of one's own: one robot whose masses drift at 1 m/s along x.
class Drift final : public Backend {
 public:
  std::string device_name() const override { return "drift"; }
  std::vector<std::string> notes() const override { return {}; }
  std::size_t robots_at_once() const override { return 1; }
  double spring_limit() const override { return 0; }
  double busy_seconds() const override { return 0; }
  void load(std::span<const Robot* const> robots, const Configuration&) override {
    positions_.clear();
    for (const Robot* robot : robots) positions_ = robot->masses;
  }
  void configure(const Configuration&) override {}
  void step(const Clock& clock, std::int64_t steps) override {
    for (Vec3& x : positions_) x.x += static_cast<float>(clock.dt * static_cast<double>(steps));
  }
  void read(std::size_t, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    read_positions(positions);
    read_velocities(velocities);
  }
  void write(std::size_t, std::span<const Vec3> positions, std::span<const Vec3>) override {
    positions_.assign(positions.begin(), positions.end());
  }
  void read_positions(std::span<Vec3> out) const override { std::ranges::copy(positions_, out.begin()); }
  void read_velocities(std::span<Vec3> out) const override { std::ranges::fill(out, Vec3{1, 0, 0}); }
  RobotStatus status(std::size_t) const override { return {}; }
  std::vector<RobotStatus> statuses() const override { return std::vector<RobotStatus>(1); }
  void set_status(std::size_t, const RobotStatus&) override {}
  void write_materials(std::span<const Material>) override {}
  void write_materials(std::size_t, std::span<const Material>) override {}
  void set_perturbations(std::span<const Perturbation>) override {}
  void report(const Clock&, std::span<Telemetry> telemetry, std::span<RobotStatus>) const override {
    for (Telemetry& robot : telemetry) robot.velocity = {1, 0, 0};
  }

 private:
  std::vector<Vec3> positions_;
};

int main() {
  const Robot cube = make_voxel_robot(VoxelGrid(1, 1, 1, tissue));
  Simulation simulation({}, {&cube, 1});
  simulation.step(10);
  if (cube.springs.size() != 28 || simulation.steps() != 10) return 1;

  const auto materials = materials_at(materials_of(cube), simulation.configuration().environment, simulation.clock());
  if (spring_forces(cube, materials, simulation.positions(0)).size() != 8) return 2;

  Configuration configuration;
  configuration.dt = 0.5;
  Simulation drifting(configuration, {&cube, 1}, std::make_unique<Drift>());
  drifting.step(4);
  const float way = drifting.positions(0)[0].x - cube.masses[0].x;
  if (!(way > 1.99f && way < 2.01f && drifting.telemetry(0).velocity.x == 1)) return 3;

  const std::vector<double> ones(quantities().size(), 1);
  return Objective("2 * distance + 1").score(ones) == 3 ? 0 : 4;
}
