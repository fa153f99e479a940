// SPDX-License-Identifier: Apache-2.0
// The water's forces on the faces of a body, one tile of face pairs after the other.
#pragma once

#include "sim/cpu/kernels/body_arrays.h"
#include "sim/physics/fixed_point.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// A third of the forces on the two faces (a, b, c) and (a, c, d) of each pair, in units.
struct FaceForces {
  Lanes3 first, second;
  Lanes fastest_squared;  // the larger of the squared sums of velocities of either face

  // The same with the offsets of fixed_point.h.
  HWY_INLINE FaceForces dithered(Words offset, Lanes factor) const {
    return {mercury::dithered(first, offset, factor),
            mercury::dithered(second, offset + Words(second_face_dither), factor), fastest_squared};
  }

  HWY_INLINE Integers largest_component() const {
    const auto of = [](Lanes3 f) HWY_ATTR { return larger(magnitude(f.x), larger(magnitude(f.y), magnitude(f.z))); };
    return larger(of(first), of(second));
  }
};

// `to_b`, `to_c`, `to_d`: from corner a to the others. `first`, `second`: the sum of the velocities of each face's
// corners, relative to the water. `coefficients`: OceanModel::of_sums().
template <class EnvironmentModel>
HWY_INLINE FaceForces face_forces(FaceCoefficients<Lanes> coefficients, Lanes3 to_b, Lanes3 to_c, Lanes3 to_d,
                                  Lanes3 first, Lanes3 second) {
  const Lanes first_squared = inner(first, first), second_squared = inner(second, second);
  return {EnvironmentModel::on_face(cross(to_c, to_b), first, first_squared, coefficients),
          EnvironmentModel::on_face(cross(to_d, to_c), second, second_squared, coefficients),
          larger(first_squared, second_squared)};
}

template <class EnvironmentModel>
class FaceTiles {
 public:
  // `dither` is dither_of_step().
  FaceTiles(Body& body, const EnvironmentModel& model, std::uint32_t dither)
      : arrays_(body), dither_of_pairs_(body.face_dither.data()), dither_(dither), dither_factor_(model.dither()),
        tiles_(body.face_tiles.data()), end_(tiles_ + body.face_tiles.size()),
        coefficients_(model.of_sums(body.scale.environment)),
        bound_per_squared_speed_(coefficients_.bound() * body.squared_diagonal),
        thrice_flow_(broadcast_aos(model.thrice_flow)) {}

  // Adds a third of each face's force to each of its masses. Returns false if a force is out of range. The forces are
  // searched for that only if a bound, from the size of the body and its fastest face, does not exclude it.
  bool add_forces() const {
    Lanes fastest_squared = 0.0f;
    for (const std::uint32_t* tile = tiles_; tile != end_; tile += 4 * lane_count) {
      FaceForces f = forces(tile);
      if constexpr (EnvironmentModel::real_bodies)
        f = f.dithered(load_aligned(dither_of_pairs_ + (tile - tiles_) / 4) + Words(dither_), dither_factor_);
      fastest_squared = larger(fastest_squared, f.fastest_squared);
      const Integers3 on_b = round_to_int(f.first), on_d = round_to_int(f.second), on_both = on_b + on_d;
      scatter_add(on_both, arrays_.scattered, tile);
      scatter_add(on_b, arrays_.scattered, tile + lane_count);
      scatter_add(on_both, arrays_.scattered, tile + 2 * lane_count);
      scatter_add(on_d, arrays_.scattered, tile + 3 * lane_count);
    }
    return every(fastest_squared * bound_per_squared_speed_ < 0.5f * face_limit_units) || forces_fit();
  }

  // Calls visit(slot) for the corners of all face pairs with a force out of range.
  template <class Visit>
  void for_each_bad_corner(const Visit& visit) const {
    for (const std::uint32_t* tile = tiles_; tile != end_; tile += 4 * lane_count) {
      const FaceForces f = forces(tile);
      const std::uint32_t good = bits_of(fits(f.first) & fits(f.second));
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        for (std::size_t k = 0; k < 4 && (good >> lane & 1) == 0; ++k) visit(tile[k * lane_count + lane] / 4);
    }
  }

 private:
  HWY_INLINE FaceForces forces(const std::uint32_t* tile) const {
    const std::uint32_t *const a = tile, *const b = a + lane_count, *const c = b + lane_count,
                               *const d = c + lane_count;
    const Aos xa = x(a);
    Aos common = v(a) + v(c);
    if constexpr (!EnvironmentModel::still_water) common = common - thrice_flow_;
    return face_forces<EnvironmentModel>(
        FaceCoefficients<Lanes>{coefficients_.drag, coefficients_.lift, coefficients_.tangential, coefficients_.normal},
        components(x(b) - xa), components(x(c) - xa), components(x(d) - xa), components(common + v(b)),
        components(common + v(d)));
  }
  HWY_NOINLINE bool forces_fit() const {
    Integers largest_force = zeros();
    for (const std::uint32_t* tile = tiles_; tile != end_; tile += 4 * lane_count)
      largest_force = larger(largest_force, forces(tile).largest_component());
    return largest(largest_force) < mercury::bits_of(face_limit_units);
  }
  HWY_INLINE Aos x(const std::uint32_t* corner) const { return gather(arrays_.x_aos, corner); }
  HWY_INLINE Aos v(const std::uint32_t* corner) const { return gather(arrays_.v_aos, corner); }

  const BodyArrays arrays_;
  const std::uint32_t* const dither_of_pairs_;
  const std::uint32_t dither_;
  const float dither_factor_;
  const std::uint32_t *const tiles_, *const end_;  // tile_faces()
  const FaceCoefficients<float> coefficients_;
  const float bound_per_squared_speed_;
  const Aos thrice_flow_;
};

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
