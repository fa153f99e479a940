// SPDX-License-Identifier: Apache-2.0
// The water's forces on all faces of a body.
#pragma once

#include "sim/cpu/arrays.h"
#include "sim/physics/fixed_point.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// The forces on two faces (a, b, c) and (a, c, d), a third of each, in units.
struct FaceForces {
  Lanes3 first, second;
  Lanes fastest_squared;  // the larger of the squares of what both velocities sum up to

  HWY_INLINE Integers largest_component() const {
    const auto of = [](Lanes3 f) HWY_ATTR { return larger(magnitude(f.x), larger(magnitude(f.y), magnitude(f.z))); };
    return larger(of(first), of(second));
  }
};

// The ways from a to the other corners, and the sum of the velocities of each face's corners relative to the water;
// of_sums() by `drag`, `lift`.
template <class EnvironmentModel>
HWY_INLINE FaceForces face_forces(Lanes drag, Lanes lift, Lanes3 to_b, Lanes3 to_c, Lanes3 to_d, Lanes3 first,
                                  Lanes3 second) {
  const Lanes first_squared = inner(first, first), second_squared = inner(second, second);
  return {EnvironmentModel::on_face(cross(to_c, to_b), first, first_squared, drag, lift),
          EnvironmentModel::on_face(cross(to_d, to_c), second, second_squared, drag, lift),
          larger(first_squared, second_squared)};
}

template <class EnvironmentModel>
class Skin {
 public:
  Skin(Body& body, const EnvironmentModel& model)
      : arrays_(body), corners_(body.faces.data()), corners_end_(corners_ + body.faces.size()),
        coefficients_(model.of_sums(body.scale.force)),
        most_per_squared_speed_(coefficients_.most() * body.squared_diagonal),
        thrice_flow_(row_in_every(model.thrice_flow)) {}

  // Adds a third of each face's force to each of its masses. False if a force is out of range. That is looked for only
  // where no bound excludes it.
  bool add_forces() const {
    Lanes fastest_squared = 0.0f;
    for (const std::uint32_t* corner = corners_; corner != corners_end_; corner += 4 * lane_count) {
      const FaceForces f = forces(corner);
      fastest_squared = larger(fastest_squared, f.fastest_squared);
      const Integers3 on_b = round_to_int(f.first), on_d = round_to_int(f.second), on_both = on_b + on_d;
      add_to_rows(on_both, arrays_.row_sums, corner);
      add_to_rows(on_b, arrays_.row_sums, corner + lane_count);
      add_to_rows(on_both, arrays_.row_sums, corner + 2 * lane_count);
      add_to_rows(on_d, arrays_.row_sums, corner + 3 * lane_count);
    }
    return every(fastest_squared * most_per_squared_speed_ < 0.5f * face_limit_units) || forces_fit();
  }

  // Calls visit(place) for the corners of all pairs of faces with a force out of range.
  template <class Visit>
  void for_each_bad_corner(const Visit& visit) const {
    for (const std::uint32_t* corner = corners_; corner != corners_end_; corner += 4 * lane_count) {
      const FaceForces f = forces(corner);
      const std::uint32_t good = bits_of(fits(f.first) & fits(f.second));
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        for (std::size_t k = 0; k < 4 && (good >> lane & 1) == 0; ++k) visit(corner[k * lane_count + lane] / 4);
    }
  }

 private:
  // Of pairs of faces, whose corners stand one after the other.
  HWY_INLINE FaceForces forces(const std::uint32_t* corner) const {
    const std::uint32_t *const a = corner, *const b = a + lane_count, *const c = b + lane_count,
                               *const d = c + lane_count;
    const Rows xa = x(a);
    Rows common = v(a) + v(c);
    if constexpr (!EnvironmentModel::still_water) common = common - thrice_flow_;
    return face_forces<EnvironmentModel>(coefficients_.drag, coefficients_.lift, vectors(x(b) - xa), vectors(x(c) - xa),
                                         vectors(x(d) - xa), vectors(common + v(b)), vectors(common + v(d)));
  }
  HWY_NOINLINE bool forces_fit() const {
    Integers largest_force = no_integers();
    for (const std::uint32_t* corner = corners_; corner != corners_end_; corner += 4 * lane_count)
      largest_force = larger(largest_force, forces(corner).largest_component());
    return largest(largest_force) < mercury::bits_of(face_limit_units);
  }
  HWY_INLINE Rows x(const std::uint32_t* corner) const { return collect(arrays_.x_rows, corner); }
  HWY_INLINE Rows v(const std::uint32_t* corner) const { return collect(arrays_.v_rows, corner); }

  const Arrays arrays_;
  const std::uint32_t *const corners_, *const corners_end_;
  const OceanModel::Coefficients coefficients_;
  const float most_per_squared_speed_;
  const Rows thrice_flow_;
};

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
