// SPDX-License-Identifier: Apache-2.0
// The faces of a step: the force of the flow on each face, a third of it to each of its masses.
#pragma once

#include "sim/cuda/block_robot.cuh"
#include "sim/physics/fixed_point.h"

namespace mercury::cuda {

// Each warp takes every `warps`th face tile, one pair per lane.
template <bool prefetches>
class FacePass {
 public:
  // Loads this thread's first pair early, so that add() need not wait for it.
  template <class Robot>
  __device__ void prefetch(const Robot& robot) {
    if (prefetches && first_pair(robot) < robot.header().face_pairs) first_ = load(robot, first_pair(robot));
  }

  // After prefetch(). `units_per_newton` of the sums; `dither` is dither_of_step().
  template <class Robot, class EnvironmentModel>
  __device__ void add(const Robot& robot, const EnvironmentModel& model, float units_per_newton, std::uint32_t step,
                      std::uint32_t dither, Failure& failure) const {
    // Normals will be twice as long as of_sums() expects them.
    const FaceCoefficients<float> by = model.of_sums(0.5f * units_per_newton);
    uint2 next = first_;
    if (!prefetches && first_pair(robot) < robot.header().face_pairs) next = load(robot, first_pair(robot));
    for (std::uint32_t p = first_pair(robot); p < robot.header().face_pairs; p += robot.threads()) {
      const Corners corners{next.x, next.y};
      if (p + robot.threads() < robot.header().face_pairs) next = load(robot, p + robot.threads());
      if (corners.are_padding()) continue;
      if (!add_pair(robot, model, by, corners, p, dither + dither_of(robot, p)))
        failure.report<typename Robot::Memory>(robot.arguments().launch, step, phase_environment,
                                               lowest_mass(robot, corners));
    }
  }

 private:
  // Their addresses (layout.h), as in a FacePair.
  struct Corners {
    std::uint32_t ab, cd;
    // A single face may have a = b or a = d.
    __device__ bool are_padding() const { return ((ab ^ cd) & 0xffff) == 0; }
  };

  // The warps begin that have less to do: the first ones if the last have more tiles, or else the last ones, of which
  // one has the tile that may be partly empty.
  template <class Robot>
  __device__ static std::uint32_t first_pair(const Robot& robot) {
    const std::uint32_t warp = robot.context().warp;
    return (robot.arguments().launch.even_tiles ? robot.warps() - 1 - warp : warp) * lanes + robot.context().lane;
  }
  template <class Robot>
  __device__ static uint2 load(const Robot& robot, std::uint32_t p) {
    const BatchView& batch = robot.arguments().batch;
    const FacePair* pairs = batch.face_pairs + robot.chunk() * batch.face_stride;
    return __ldg(reinterpret_cast<const uint2*>(pairs + p));
  }
  template <class Robot>
  __device__ static std::uint32_t dither_of(const Robot& robot, std::uint32_t p) {
    if constexpr (Robot::Memory::in_parts)
      return __ldg(robot.arguments().batch.parts.face_dithers + robot.chunk() * robot.arguments().batch.face_stride +
                   p);
    else
      return dither_of_pair(p);
  }

  // Returns false if a force is too large for its fixed-point sum, or NaN.
  template <class Robot, class EnvironmentModel>
  __device__ static bool add_pair(const Robot& robot, const EnvironmentModel& model, const FaceCoefficients<float>& by,
                                  Corners corners, std::uint32_t p, std::uint32_t dither) {
    const auto a = robot.template corner<false>(corners.ab), b = robot.template corner<true>(corners.ab),
               c = robot.template corner<false>(corners.cd), d = robot.template corner<true>(corners.cd);
    const Vec3 xa = a.vector(field_x), xb = b.vector(field_x), xc = c.vector(field_x), xd = d.vector(field_x);
    // 2 (xb - xa) x (xc - xa) = ((xb - xa) + (xb - xc)) x (xc - xa). To exchange a and c, or b and d, changes at most
    // the sign of the right side, and of no bit else. So no force depends on the vertex order.
    const Vec3 shared_edge = xc - xa;
    const Vec3 first_normal = cross((xb - xa) + (xb - xc), shared_edge);
    const Vec3 second_normal = cross((xd - xa) + (xd - xc), shared_edge);
    Vec3 relative = a.vector(field_v) + c.vector(field_v);
    if constexpr (EnvironmentModel::has_flow) relative = relative - model.thrice_flow;
    Vec3 first_sum = relative + b.vector(field_v), second_sum = relative + d.vector(field_v);
    FaceCoefficients<float> on_first = by, on_second = by;
    if constexpr (EnvironmentModel::has_one_sided_water)
      if (model.one_sided) {
        const BatchView& batch = robot.arguments().batch;
        const std::uint32_t backs = __ldg(batch.face_backs + robot.chunk() * batch.face_stride + p);
        const auto behind_first = robot.mass_at(backs & 0xffff), behind_second = robot.mass_at(backs >> 16);
        model.see_from_outside(first_normal, behind_first.vector(field_x) - xa, behind_first.vector(field_v), first_sum,
                               on_first);
        model.see_from_outside(second_normal, behind_second.vector(field_x) - xa, behind_second.vector(field_v),
                               second_sum, on_second);
      }
    Vec3 first = model.on_face(first_normal, first_sum, inner(first_sum, first_sum), on_first);
    Vec3 second = model.on_face(second_normal, second_sum, inner(second_sum, second_sum), on_second);
    if (!fits(first) || !fits(second)) return false;
    if constexpr (EnvironmentModel::real_bodies) {
      first = dithered(first, dither, model.dither());
      second = dithered(second, dither + second_face_dither, model.dither());
    }
    const int x1 = round_to_int(first.x), y1 = round_to_int(first.y), z1 = round_to_int(first.z);
    const int x2 = round_to_int(second.x), y2 = round_to_int(second.y), z2 = round_to_int(second.z);
    b.add_to_sum(x1, y1, z1);
    d.add_to_sum(x2, y2, z2);
    a.add_to_sum(x1 + x2, y1 + y2, z1 + z2);
    c.add_to_sum(x1 + x2, y1 + y2, z1 + z2);
    return true;
  }

  template <class Robot>
  __device__ static std::uint32_t lowest_mass(const Robot& robot, Corners corners) {
    const auto number = [&](std::uint32_t address) { return robot.number_of(Robot::slot_of_corner(address)); };
    return min(min(number(corners.ab & 0xffff), number(corners.ab >> 16)),
               min(number(corners.cd & 0xffff), number(corners.cd >> 16)));
  }

  uint2 first_{};
};

}  // namespace mercury::cuda
