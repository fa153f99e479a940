// SPDX-License-Identifier: Apache-2.0
// An independent implementation of the physics: one robot in double precision, written from the paper for reading, not
// for speed. It shares no equation with sim/, only the plain data that describes what to simulate.
#pragma once

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/simulation.h"

namespace mercury::reference {

using Vector = Eigen::Vector3d;
using Field = std::vector<Vector>;  // one vector per mass

Vector vector_of(Vec3 v);

// L(t) of a spring [m]: the muscle law of paper, II.A.
double rest_length(const Material& material, double rest_length, double time);

class Reference {
 public:
  // Starts at time 0 in the rest pose; on the ground with the lowest mass at z = 0.
  Reference(const Configuration& configuration, const Robot& robot);

  void set_state(const State& state);
  void set_perturbations(std::vector<Perturbation> perturbations) { perturbations_ = std::move(perturbations); }
  void step(std::int64_t steps = 1);

  const Field& positions() const { return x_; }
  const Field& velocities() const { return v_; }
  double time() const { return static_cast<double>(steps_) * configuration_.dt; }

  Vector center_of_mass() const;
  Vector center_velocity() const;
  double kinetic_energy() const;
  double elastic_energy() const;  // at the springs' current rest lengths
  double muscle_power() const;
  double largest_strain() const;                     // against L0
  std::int64_t springs_beyond(double strain) const;  // stretched or pressed together by more

 private:
  Field environment_forces() const;
  Field spring_forces() const;
  void project_springs(Field& predicted) const;
  void resolve_contact(Field& next) const;
  double stiffness(const Spring& spring) const;
  double length_now(const Spring& spring) const;
  double strain(const Spring& spring) const;
  void set_inertia();
  int mass_behind(const Face& face) const;
  void add_surface_drag(const FaceDrag& ocean, Field& force) const;
  void add_resistive_drag(const ResistiveDrag& water, Field& force) const;
  void add_repulsion(const Contacts& contacts, Field& force) const;

  Configuration configuration_;
  Robot robot_;
  std::vector<Perturbation> perturbations_;
  std::set<std::pair<int, int>> joined_;  // both orders
  std::vector<double> springs_at_;        // s, one per mass
  std::vector<double> inverse_inertia_;   // [1/kg], one per mass; 0 = fixed
  std::vector<double> weight_;            // what gravity acts on [kg], one per mass
  double contact_distance_ = 0;           // [m]
  std::vector<int> behind_;               // the mass behind each face, or -1; empty unless water is one-sided
  Field x_, v_;
  std::int64_t steps_ = 0;
};

// The largest distance between two positions of the same mass [m].
double largest_deviation(const Field& expected, const std::vector<Vec3>& actual);

}  // namespace mercury::reference
