// SPDX-License-Identifier: Apache-2.0
// What a step of the CPU is told, and the parts of it that are not vector code.
#pragma once

#include <variant>

#include "sim/physics/environments.h"
#include "sim/physics/integration.h"

#include "sim/cpu/body.h"

namespace mercury::cpu {

struct ContactLaw {
  float stiffness = 0;  // k_c times the stiffness scale [N/m]; 0 = no self-collision
};

using AnyEnvironmentModel = std::variant<OceanModel, OceanSimpleModel, LandModel>;

// L(t) / L0 of every muscle, step after step.
struct Factors {
  const float* first = nullptr;
  std::size_t muscles = 0;
  const float* of_step(std::int64_t step) const { return first + static_cast<std::size_t>(step) * muscles; }
};

struct StepSetting {
  Solver solver = Solver::force;
  AnyEnvironmentModel model = OceanModel(Ocean{});
  ContactLaw contact;
  StepConstants constants;
};

StepSetting setting_of(const Configuration& configuration);

// Adds the forces of pulls and of contacts between listed pairs to the sums.
void add_perturbations(Body& body);
void add_contacts(Body& body, float stiffness);
// Contacts at positions(place): calls add(place, units) for both masses of a pair that touches.
template <class Positions, class Add>
void for_each_contact(const Body& body, float stiffness, const Positions& positions, const Add& add) {
  const float distance = body.measures.contact_distance();
  for (const auto& [i, j] : body.near_pairs.pairs()) {
    const Vec3 d = positions(j) - positions(i);
    const float squared = squared_length(d);
    if (!(squared < distance * distance)) continue;
    const Vec3 units = repulsion(squared, distance, stiffness * body.scale.force) * d;
    add(i, units);
    add(j, -units);
  }
}
// Rounds and wraps around.
inline void add_units(std::int32_t& sum, float units) {
  sum = static_cast<std::int32_t>(static_cast<std::uint32_t>(sum) + static_cast<std::uint32_t>(round_to_int(units)));
}

// A state from outside may hold masses that are out of reach already. Notes the lowest and returns false if it does.
bool accept_state(Body& body);

// Notes that a step ended in an explosion and clears what it left half done.
void explode(Body& body, std::int64_t step);

}  // namespace mercury::cpu
