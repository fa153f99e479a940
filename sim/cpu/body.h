// SPDX-License-Identifier: Apache-2.0
// One robot as the CPU steps it: structure of arrays, so that a vector holds the same quantity of several masses.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "mercury/backend.h"
#include "sim/cpu/aligned.h"
#include "sim/cpu/cells.h"
#include "sim/cpu/near_pairs.h"
#include "sim/cpu/places.h"
#include "sim/cpu/spring_plan.h"
#include "sim/physics/measures.h"

namespace mercury::cpu {

// Three numbers a place.
template <class T>
struct Triples {
  Aligned<T> x, y, z;
  void assign(std::size_t n, T value) {
    x.assign(n, value);
    y.assign(n, value);
    z.assign(n, value);
  }
};

// What acts on the masses, in units of FixedPointScale. All but `own` only grow, wrapping around: what was added since
// a sum was last taken is a difference, and nothing needs to be set back to zero.
struct Sums {
  Triples<std::int32_t> own;  // of the springs that a mass owns, in this step
  Triples<std::int32_t>
      reaction;                 // of the runs it is partner in, pulls and contacts: reaction_arrays one after the other
  Aligned<std::int32_t> rows;   // of the rows it is partner in and of faces: x, y, z and a fourth without meaning
  Triples<std::int32_t> taken;  // reaction, with or without rows, when it was last taken
  bool with_rows = false;
};
void clear(Sums& sums);

struct Lockstep;

// Where the state of a body is that is stepped in a group's lane.
struct Residence {
  Lockstep* group = nullptr;               // nullptr = in the body itself
  const float *x = nullptr, *v = nullptr;  // [seat][x, y, z][lane], from its own lane on
  const std::uint32_t* seats = nullptr;    // by mass
  std::size_t lanes = 1;

  Vec3 at(const float* values, std::size_t mass) const {
    const float* const first = values + 3 * lanes * seats[mass];
    return {first[0], first[lanes], first[2 * lanes]};
  }
};

struct Body {
  const Robot* robot = nullptr;
  RobotMeasures measures;
  std::uint64_t topology_key = 0;  // mercury/robot.h
  std::vector<FacePair> face_pairs;
  std::vector<Cell> cells;  // sim/cpu/cells.h
  Places places;
  SpringPlan springs;
  std::vector<std::uint32_t> faces;  // plan_faces()
  NearPairs near_pairs;
  std::vector<Material> materials;  // max_materials elements
  FixedPointScale scale;
  // Of each spring, in units: what it pulls with for each part of its length that is too much. None of air.
  std::vector<float> hardness;

  Residence residence;            // while it is elsewhere, x and v are anything
  Triples<float> x, v;            // during XPBD's springs: the prediction and v + dt F
  Aligned<float> x_rows, v_rows;  // the same four to a place, for masses that are collected one by one; the fourth
                                  // is without meaning
  Sums sums;

  // Of a box around all masses [m2]; infinite if not known.
  float squared_diagonal = std::numeric_limits<float>::infinity();
  bool rows_are_current = false;  // x_rows and v_rows
  bool written = true;            // the state came from outside and may be anything
  RobotStatus status;
  std::vector<Perturbation> perturbations;

  Vec3 position(std::size_t mass) const {
    return residence.group ? residence.at(residence.x, mass) : at(x, places.of_mass[mass]);
  }
  Vec3 velocity(std::size_t mass) const {
    return residence.group ? residence.at(residence.v, mass) : at(v, places.of_mass[mass]);
  }
  static Vec3 at(const Triples<float>& values, std::size_t place) {
    return {values.x[place], values.y[place], values.z[place]};
  }
};

// A body for kernels of so many lanes, its state not set yet.
Body make_body(const Robot& robot, std::size_t lanes);

// What depends on materials and configuration.
void update_laws(Body& body, const Configuration& configuration);

// Has the body's springs read these factors, by material.
void set_factors(Body& body, const std::array<FactorId, max_materials>& factors);

// The body must not reside in a group.
void set_state(Body& body, std::span<const Vec3> positions, std::span<const Vec3> velocities);

}  // namespace mercury::cpu
