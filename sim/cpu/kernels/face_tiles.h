// SPDX-License-Identifier: Apache-2.0
// The water's forces on the faces of a body, one run or tile of face pairs after the other
// (FaceSchedule).
#pragma once

#include "sim/cpu/kernels/body_arrays.h"
#include "sim/physics/fixed_point.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// A third of the forces on the two faces (a, b, c) and (a, c, d) of each pair, in units.
struct FaceForces {
  Lanes3 first, second;
  Lanes fastest_squared;  // the larger of the squared sums of velocities of
                          // either face

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
// corners, relative to the water. `coefficients`: OceanModel::of_sums(). `back(0)` and `back(1)` are the masses behind
// the two faces, as seen from a; they are asked for only if water is one-sided.
struct Back {
  Lanes3 to, velocity;
};
template <class EnvironmentModel, class BackOf>
HWY_INLINE FaceForces face_forces(const EnvironmentModel& model, FaceCoefficients<Lanes> coefficients, Lanes3 to_b,
                                  Lanes3 to_c, Lanes3 to_d, Lanes3 first, Lanes3 second, const BackOf& back_of) {
  const Lanes3 first_normal = cross(to_c, to_b), second_normal = cross(to_d, to_c);
  FaceCoefficients<Lanes> on_first = coefficients, on_second = coefficients;
  if constexpr (EnvironmentModel::has_one_sided_water)
    if (model.one_sided) {
      const Back behind_first = back_of(0), behind_second = back_of(1);
      model.see_from_outside(first_normal, behind_first.to, behind_first.velocity, first, on_first);
      model.see_from_outside(second_normal, behind_second.to, behind_second.velocity, second, on_second);
    }
  const Lanes first_squared = inner(first, first), second_squared = inner(second, second);
  return {EnvironmentModel::on_face(first_normal, first, first_squared, on_first),
          EnvironmentModel::on_face(second_normal, second, second_squared, on_second),
          larger(first_squared, second_squared)};
}

// Lanes of a run of faces that have a pair.
HWY_INLINE Mask mask_of(std::uint32_t lanes) {
  std::uint8_t bytes[8] = {static_cast<std::uint8_t>(lanes), static_cast<std::uint8_t>(lanes >> 8)};
  return {hn::LoadMaskBits(floats, bytes)};
}
HWY_INLINE Integers3 only(Mask lanes, Integers3 a) {
  const auto in = hn::RebindMask(integers, lanes.m);
  return {{hn::IfThenElseZero(in, a.x.v)}, {hn::IfThenElseZero(in, a.y.v)}, {hn::IfThenElseZero(in, a.z.v)}};
}

template <class EnvironmentModel>
class FaceTiles {
 public:
  // `dither` is dither_of_step().
  FaceTiles(Body& body, const EnvironmentModel& model, std::uint32_t dither)
      : arrays_(body), faces_(body.faces), model_(model), dither_(dither), dither_factor_(model.dither()),
        coefficients_(model.of_sums(body.scale.environment)),
        bound_per_squared_speed_(coefficients_.bound() * body.squared_diagonal), thrice_flow_(model.thrice_flow),
        thrice_flow_aos_(broadcast_aos(model.thrice_flow)) {}

  // Adds a third of each face's force to each of its masses. Returns false if a force is out of range. The forces are
  // searched for that only if a bound, from the size of the body and its fastest face, does not exclude it.
  bool add_forces() const {
    Lanes fastest_squared = 0.0f;
    const std::size_t stride = arrays_.reaction_stride;
    for_each_run([&](const FaceSchedule::Run& run, Mask lanes, const FaceForces& f) HWY_ATTR {
      fastest_squared = larger(fastest_squared, select(lanes, f.fastest_squared, 0.0f));
      const Integers3 on_b = only(lanes, round_to_int(f.first)), on_d = only(lanes, round_to_int(f.second)),
                      on_both = on_b + on_d;
      static_assert(reaction_arrays >= 3);
      const auto& [a, b, c, d] = run.corners;
      add(on_both, arrays_.reaction, a);
      add(on_b, arrays_.reaction, stride + b);
      add(on_both, arrays_.reaction, 2 * stride + c);
      add(on_d, arrays_.reaction, d);
    });
    for_each_tile([&](const std::uint32_t* tile, const FaceForces& f) HWY_ATTR {
      fastest_squared = larger(fastest_squared, f.fastest_squared);
      const Integers3 on_b = round_to_int(f.first), on_d = round_to_int(f.second), on_both = on_b + on_d;
      scatter_add(on_both, arrays_.scattered, tile);
      scatter_add(on_b, arrays_.scattered, tile + lane_count);
      scatter_add(on_both, arrays_.scattered, tile + 2 * lane_count);
      scatter_add(on_d, arrays_.scattered, tile + 3 * lane_count);
    });
    return every(fastest_squared * bound_per_squared_speed_ < 0.5f * face_limit_units) || forces_fit();
  }

  // Calls visit(slot) for the corners of all face pairs with a force out of range.
  template <class Visit>
  void for_each_bad_corner(const Visit& visit) const {
    for_each_run([&](const FaceSchedule::Run& run, Mask, const FaceForces& f) {
      const std::uint32_t bad = run.lanes & ~good_lanes(f);
      for (std::uint32_t lane = 0; lane < lane_count; ++lane)
        for (std::size_t k = 0; k < 4 && (bad >> lane & 1) != 0; ++k) visit(run.corners[k] + lane);
    });
    for_each_tile([&](const std::uint32_t* tile, const FaceForces& f) {
      const std::uint32_t good = good_lanes(f);
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        for (std::size_t k = 0; k < 4 && (good >> lane & 1) == 0; ++k) visit(tile[k * lane_count + lane] / 4);
    });
  }

 private:
  static std::uint32_t good_lanes(const FaceForces& f) { return bits_of(fits(f.first) & fits(f.second)); }

  // Calls visit(run, lanes, FaceForces) for all runs. Forces in other lanes mean nothing.
  template <class Visit>
  HWY_INLINE void for_each_run(const Visit& visit) const {
    const Lanes3 thrice_flow{thrice_flow_.x, thrice_flow_.y, thrice_flow_.z};
    const std::uint32_t* dither = faces_.dither.data();
    for (const FaceSchedule::Run& run : faces_.runs) {
      const auto& [a, b, c, d] = run.corners;
      const Lanes3 xa = load(arrays_.x, a);
      Lanes3 common = load(arrays_.v, a) + load(arrays_.v, c);
      if constexpr (!EnvironmentModel::still_water) common = common - thrice_flow;
      visit(run, mask_of(run.lanes),
            dithered(face_forces(model_, coefficients(), load(arrays_.x, b) - xa, load(arrays_.x, c) - xa,
                                 load(arrays_.x, d) - xa, common + load(arrays_.v, b), common + load(arrays_.v, d),
                                 [&](std::size_t face) HWY_ATTR {
                                   const std::uint32_t* const behind = back_of(dither, face);
                                   return Back{components(x(behind)) - xa, components(v(behind))};
                                 }),
                     dither));
      dither += lane_count;
    }
  }
  // Calls visit(corners, FaceForces) for all tiles of gathered faces.
  template <class Visit>
  HWY_INLINE void for_each_tile(const Visit& visit) const {
    const std::uint32_t* dither = faces_.dither.data() + faces_.runs.size() * lane_count;
    const std::uint32_t* const end = faces_.tiles.data() + faces_.tiles.size();
    for (const std::uint32_t* tile = faces_.tiles.data(); tile != end; tile += 4 * lane_count) {
      const std::uint32_t *const a = tile, *const b = a + lane_count, *const c = b + lane_count,
                                 *const d = c + lane_count;
      const Aos xa = x(a);
      Aos common = v(a) + v(c);
      if constexpr (!EnvironmentModel::still_water) common = common - thrice_flow_aos_;
      visit(tile, dithered(face_forces(model_, coefficients(), components(x(b) - xa), components(x(c) - xa),
                                       components(x(d) - xa), components(common + v(b)), components(common + v(d)),
                                       [&](std::size_t face) HWY_ATTR {
                                         const std::uint32_t* const behind = back_of(dither, face);
                                         return Back{components(x(behind) - xa), components(v(behind))};
                                       }),
                           dither));
      dither += lane_count;
    }
  }
  HWY_INLINE FaceForces dithered(const FaceForces& forces, const std::uint32_t* of_pairs) const {
    if constexpr (EnvironmentModel::real_bodies)
      return forces.dithered(load_aligned(of_pairs) + Words(dither_), dither_factor_);
    return forces;
  }
  HWY_INLINE FaceCoefficients<Lanes> coefficients() const {
    return {coefficients_.drag, coefficients_.lift, coefficients_.tangential, coefficients_.normal};
  }
  HWY_NOINLINE bool forces_fit() const {
    Integers largest_force = zeros();
    for_each_run([&](const FaceSchedule::Run&, Mask lanes, const FaceForces& f) HWY_ATTR {
      const Integers largest_of_run = f.largest_component();
      largest_force = larger(largest_force, {hn::IfThenElseZero(hn::RebindMask(integers, lanes.m), largest_of_run.v)});
    });
    for_each_tile([&](const std::uint32_t*, const FaceForces& f)
                      HWY_ATTR { largest_force = larger(largest_force, f.largest_component()); });
    return largest(largest_force) < mercury::bits_of(face_limit_units);
  }
  HWY_INLINE Aos x(const std::uint32_t* corner) const { return gather(arrays_.x_aos, corner); }
  HWY_INLINE Aos v(const std::uint32_t* corner) const { return gather(arrays_.v_aos, corner); }
  // The masses behind the first or second faces of the pairs that have their dither here.
  HWY_INLINE const std::uint32_t* back_of(const std::uint32_t* dither, std::size_t face) const {
    return faces_.backs.data() + 2 * (dither - faces_.dither.data()) + face * lane_count;
  }

  const BodyArrays arrays_;
  const FaceSchedule& faces_;
  const EnvironmentModel& model_;
  const std::uint32_t dither_;
  const float dither_factor_;
  const FaceCoefficients<float> coefficients_;
  const float bound_per_squared_speed_;
  const Vec3 thrice_flow_;
  const Aos thrice_flow_aos_;
};

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
