// SPDX-License-Identifier: Apache-2.0
// What Simulation asks of whatever does the stepping. One file a backend; a backend that was not built is a file that
// was not compiled.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/simulation.h"
#include "mercury/telemetry.h"
#include "sim/physics/muscle.h"

namespace mercury {

inline constexpr std::uint32_t no_mass = 0xffffffffu;

struct RobotStatus {
  std::int64_t exploded_step = -1;   // -1 = not exploded
  std::uint32_t bad_mass = no_mass;  // lowest mass that left the finite, if one did
};

class Backend {
 public:
  virtual ~Backend() = default;

  virtual std::string device_name() const = 0;
  virtual std::vector<std::string> notes() const = 0;
  // As in Simulation.
  virtual std::size_t robots_at_once() const = 0;
  virtual double spring_limit() const = 0;
  virtual double busy_seconds() const = 0;

  // Takes these robots in place of all before, at rest in their files' positions, with their own materials. `robots`
  // outlives the backend.
  virtual void load(std::span<const Robot* const> robots, const Configuration& configuration) = 0;
  virtual void configure(const Configuration& configuration) = 0;
  virtual void step(const Clock& clock, std::int64_t steps) = 0;

  // One element a mass.
  virtual void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const = 0;
  virtual void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) = 0;
  // All robots' masses one after the other.
  virtual void read_positions(std::span<Vec3> out) const = 0;
  virtual void read_velocities(std::span<Vec3> out) const = 0;

  // As in Simulation; a backend without CUDA, or with several devices, leaves these as they are.
  virtual int cuda_device() const { return -1; }
  virtual void copy_positions(float* /*device_out*/) const {
    throw std::logic_error("these robots are on no CUDA device");
  }

  virtual RobotStatus status(std::size_t robot) const = 0;
  virtual std::vector<RobotStatus> statuses() const = 0;
  virtual void set_status(std::size_t robot, const RobotStatus& status) = 0;

  // size * max_materials elements, robot-major.
  virtual void write_materials(std::span<const Material> tables) = 0;
  virtual void write_materials(std::size_t robot, std::span<const Material> table) = 0;

  virtual void set_perturbations(std::span<const Perturbation> perturbations) = 0;
  // One element a robot; of its telemetry all but what follows from its status.
  virtual void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const = 0;
};

std::unique_ptr<Backend> make_cpu_backend(const Device& device);
// Throws DeviceError in a build without CUDA or when the device is not there.
std::unique_ptr<Backend> make_cuda_backend(const Device& device);

}  // namespace mercury
