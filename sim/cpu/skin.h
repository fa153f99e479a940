// The water's forces on all faces of a body.
#pragma once

#include "sim/cpu/arrays.h"
#include "sim/fixed_point.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

template <class Hooks>
class Skin {
 public:
  Skin(Body& body, const Hooks& hooks)
      : arrays_(body), corners_(body.faces.data()), corners_end_(corners_ + body.faces.size()), hooks_(hooks),
        scale_(1.0f / 3.0f * body.scale.force) {}

  // Adds a third of each face's force to each of its masses. False if a force is out of range.
  bool add_forces() const {
    Integers largest_force = no_integers();
    for (const std::uint32_t* corner = corners_; corner != corners_end_; corner += 4 * lane_count) {
      const Forces f = forces(corner);
      largest_force = larger(largest_force, larger(largest_component(f.first), largest_component(f.second)));
      const Integers3 on_b = round_to_int(f.first), on_d = round_to_int(f.second), on_both = on_b + on_d;
      add_to_rows(on_both, arrays_.row_sums, corner);
      add_to_rows(on_b, arrays_.row_sums, corner + lane_count);
      add_to_rows(on_both, arrays_.row_sums, corner + 2 * lane_count);
      add_to_rows(on_d, arrays_.row_sums, corner + 3 * lane_count);
    }
    return largest(largest_force) < mercury::bits_of(face_limit_units);
  }

  // Calls visit(place) for the corners of all pairs of faces with a force out of range.
  template <class Visit>
  void for_each_bad_corner(const Visit& visit) const {
    for (const std::uint32_t* corner = corners_; corner != corners_end_; corner += 4 * lane_count) {
      const Forces f = forces(corner);
      const std::uint32_t good = bits_of(fits(f.first) & fits(f.second));
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        for (std::size_t k = 0; k < 4 && (good >> lane & 1) == 0; ++k) visit(corner[k * lane_count + lane] / 4);
    }
  }

 private:
  struct Forces {
    Lanes3 first, second;  // a third, in units
  };

  // Of pairs of faces (a, b, c) and (a, c, d), whose corners stand one after the other.
  HWY_INLINE Forces forces(const std::uint32_t* corner) const {
    constexpr float third = 1.0f / 3.0f;
    const std::uint32_t *const a = corner, *const b = a + lane_count, *const c = b + lane_count, *const d = c + lane_count;
    const Rows xa = x(a);
    const Lanes3 to_b = vectors(x(b) - xa), to_c = vectors(x(c) - xa), to_d = vectors(x(d) - xa);
    const Rows shared = v(a) + v(c);
    const Lanes3 v_first = vectors(shared + v(b)), v_second = vectors(shared + v(d));
    return {Lanes(scale_) * hooks_.on_face(Lanes(0.5f) * cross(to_b, to_c), Lanes(third) * v_first),
            Lanes(scale_) * hooks_.on_face(Lanes(0.5f) * cross(to_c, to_d), Lanes(third) * v_second)};
  }
  HWY_INLINE Rows x(const std::uint32_t* corner) const { return collect(arrays_.x_rows, corner); }
  HWY_INLINE Rows v(const std::uint32_t* corner) const { return collect(arrays_.v_rows, corner); }

  HWY_INLINE static Integers largest_component(Lanes3 a) {
    return larger(magnitude(a.x), larger(magnitude(a.y), magnitude(a.z)));
  }

  const Arrays arrays_;
  const std::uint32_t *const corners_, *const corners_end_;
  const Hooks hooks_;
  const float scale_;  // units in a newton, of a third
};

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
