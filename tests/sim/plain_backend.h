// SPDX-License-Identifier: Apache-2.0
// A backend that has only what every backend must have, to test the defaults of the others.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mercury/backend.h"

namespace mercury::test {

// A CPU backend behind the interface, without its own add(), keep() and step_and_report().
class PlainBackend : public Backend {
 public:
  explicit PlainBackend(std::unique_ptr<Backend> cpu = make_cpu_backend({})) : cpu_(std::move(cpu)) {}
  std::string device_name() const override { return cpu_->device_name(); }
  std::vector<std::string> notes() const override { return cpu_->notes(); }
  std::size_t robots_at_once() const override { return cpu_->robots_at_once(); }
  double spring_limit() const override { return cpu_->spring_limit(); }
  double busy_seconds() const override { return cpu_->busy_seconds(); }
  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    cpu_->load(robots, configuration);
  }
  BatchSettings settings() const override { return cpu_->settings(); }
  void configure(const Configuration& configuration) override { cpu_->configure(configuration); }
  void step(const Clock& clock, std::int64_t steps) override { cpu_->step(clock, steps); }
  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    cpu_->read(robot, positions, velocities);
  }
  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    cpu_->write(robot, positions, velocities);
  }
  void read_positions(std::span<Vec3> out) const override { cpu_->read_positions(out); }
  void read_velocities(std::span<Vec3> out) const override { cpu_->read_velocities(out); }
  RobotStatus status(std::size_t robot) const override { return cpu_->status(robot); }
  std::vector<RobotStatus> statuses() const override { return cpu_->statuses(); }
  void set_status(std::size_t robot, const RobotStatus& status) override { cpu_->set_status(robot, status); }
  void write_materials(std::span<const Material> tables) override { cpu_->write_materials(tables); }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    cpu_->write_materials(robot, table);
  }
  void set_perturbations(std::span<const Perturbation> perturbations) override {
    cpu_->set_perturbations(perturbations);
  }
  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    cpu_->report(clock, telemetry, statuses);
  }

 private:
  std::unique_ptr<Backend> cpu_;
};

}  // namespace mercury::test
