// SPDX-License-Identifier: Apache-2.0
// The same physics as a plain loop: one spring after the other, one float at a time. Vector code must agree with it bit
// for bit, and is measured against it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "mercury/simulation.h"
#include "sim/physics/environments.h"
#include "sim/physics/face_backs.h"
#include "sim/physics/integration.h"
#include "sim/physics/measures.h"
#include "sim/physics/muscle.h"

namespace mercury::bench {

class PlainLoop {
 public:
  // Starts at rest, in the position of the robot's file. The robot must outlive the loop.
  PlainLoop(const Robot& robot, const Configuration& configuration);

  void set_state(const State& state) { state_ = state; }
  const State& state() const { return state_; }
  void set_perturbations(std::span<const Perturbation> perturbations) {
    perturbations_.assign(perturbations.begin(), perturbations.end());
  }

  // Advances unless the robot has exploded.
  void step(std::int64_t steps);
  std::int64_t exploded_step() const { return exploded_step_; }  // -1 = not exploded
  std::uint32_t bad_mass() const { return bad_mass_; }           // lowest mass that left the finite

 private:
  // Signed numbers in two's complement: when a robot explodes, they overflow, which is defined for unsigned types only.
  struct Sum {
    std::uint32_t x = 0, y = 0, z = 0;
  };

  void update_muscles();
  template <class PerDistance>
  bool add_springs(const PerDistance& per_distance_of);
  bool add_spring_forces();
  bool add_spring_corrections();
  template <class EnvironmentModel>
  bool add_face_forces(const EnvironmentModel& model);
  void add_contacts();
  void add_contact(std::uint16_t i, std::uint16_t j, float distance);
  void add_perturbations();
  template <class EnvironmentModel>
  bool add_environment(const EnvironmentModel& model);
  template <class EnvironmentModel>
  Vec3 accelerate(std::size_t mass, const EnvironmentModel& model);
  template <class EnvironmentModel>
  bool end(std::size_t mass, Vec3 x, Vec3 v, const EnvironmentModel& model);
  template <class EnvironmentModel>
  bool step_springs(const EnvironmentModel& model);
  template <class EnvironmentModel>
  bool step_force(const EnvironmentModel& model);
  template <class EnvironmentModel>
  bool step_xpbd(const EnvironmentModel& model);
  void add(std::size_t mass, Vec3 units);
  Vec3 take(std::size_t mass, float inverse_scale);
  bool store_state(std::size_t mass, Vec3 x, Vec3 v);
  bool joined(std::uint16_t i, std::uint16_t j) const;

  const Robot& robot_;
  const Configuration configuration_;
  const RobotMeasures measures_;
  FixedPointScale scale_;
  StepConstants constants_;
  std::vector<PointProperties> points_;  // by mass
  float contact_stiffness_ = 0, contact_distance_ = 0, highest_length_rate_ = 0;
  State state_;
  std::vector<Sum> sums_;
  std::vector<float> valence_sums_, relaxation_times_;  // by spring: xpbd()'s valence_sum, tau
  std::array<float, max_materials> factor_{}, stiffness_{}, compliance_{};
  std::array<MusclePhase, max_materials> phases_{};
  std::vector<FacePair> faces_;
  std::vector<PairBacks> backs_;
  std::vector<std::vector<std::uint16_t>> neighbors_;
  std::vector<std::uint16_t> heads_, links_;  // buckets of the contact grid, masses
  std::vector<Perturbation> perturbations_;
  std::int64_t now_ = 0, exploded_step_ = -1;
  std::uint32_t bad_mass_ = 0xffffffffu;
};

}  // namespace mercury::bench
