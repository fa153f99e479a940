// SPDX-License-Identifier: Apache-2.0
// The faces of a step: the force of the flow on each face, a third of it to each of its masses.
#pragma once

#include "sim/cuda/block_robot.cuh"
#include "sim/physics/fixed_point.h"

namespace mercury::cuda {

// Each warp takes every `warps`th face tile, one pair per lane.
class FacePass {
 public:
  // Loads this thread's first pair early, so that add() need not wait for it.
  template <class Robot>
  __device__ void prefetch(const Robot& robot) {
    if (first_pair(robot) < robot.header().face_pairs) first_ = load(robot, first_pair(robot));
  }

  // After prefetch(). `units_per_newton` of the sums; `dither` is dither_of_step().
  template <class Robot, class EnvironmentModel>
  __device__ void add(const Robot& robot, const EnvironmentModel& model, float units_per_newton, std::uint32_t step,
                      std::uint32_t dither, Failure& failure) const {
    ushort4 next = first_;
    for (std::uint32_t p = first_pair(robot); p < robot.header().face_pairs; p += robot.threads()) {
      const ushort4 corners = next;
      if (p + robot.threads() < robot.header().face_pairs) next = load(robot, p + robot.threads());
      if (corners.x == corners.z) continue;  // padding; a single face may have a = b or a = d
      if (!add_pair(robot, model, units_per_newton, corners, dither + dither_of_pair(p)))
        failure.report(step, phase_environment, lowest_mass(robot, corners));
    }
  }

 private:
  // The last warps begin, since the first ones are busy with the material table.
  template <class Robot>
  __device__ static std::uint32_t first_pair(const Robot& robot) {
    return (robot.warps() - 1 - robot.context().warp) * lanes + robot.context().lane;
  }
  template <class Robot>
  __device__ static ushort4 load(const Robot& robot, std::uint32_t p) {
    const BatchView& batch = robot.arguments().batch;
    const FacePair* pairs = batch.face_pairs + std::size_t{robot.context().robot} * batch.face_stride;
    return __ldg(reinterpret_cast<const ushort4*>(pairs + p));
  }

  // Returns false if a force is too large for its fixed-point sum, or NaN.
  template <class Robot, class EnvironmentModel>
  __device__ static bool add_pair(const Robot& robot, const EnvironmentModel& model, float units_per_newton,
                                  ushort4 corners, std::uint32_t dither) {
    const auto a = robot.mass_at(corners.x), b = robot.mass_at(corners.y), c = robot.mass_at(corners.z),
               d = robot.mass_at(corners.w);
    const Vec3 xa = a.vector(field_x), xb = b.vector(field_x), xc = c.vector(field_x), xd = d.vector(field_x);
    // 2 (xb - xa) x (xc - xa) = ((xb - xa) + (xb - xc)) x (xc - xa). To exchange a and c, or b and d, changes at most
    // the sign of the right side, and of no bit else. So no force depends on the vertex order.
    const Vec3 shared_edge = xc - xa;
    const Vec3 first_normal = 0.25f * cross((xb - xa) + (xb - xc), shared_edge);
    const Vec3 second_normal = 0.25f * cross((xd - xa) + (xd - xc), shared_edge);
    const Vec3 shared = a.vector(field_v) + c.vector(field_v);
    const float third = 1.0f / 3.0f;
    const float scale = third * units_per_newton;
    Vec3 first = scale * model.on_face(first_normal, third * (shared + b.vector(field_v)));
    Vec3 second = scale * model.on_face(second_normal, third * (shared + d.vector(field_v)));
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
  __device__ static std::uint32_t lowest_mass(const Robot& robot, ushort4 corners) {
    return min(min(robot.number_of(corners.x), robot.number_of(corners.y)),
               min(robot.number_of(corners.z), robot.number_of(corners.w)));
  }

  ushort4 first_{};
};

}  // namespace mercury::cuda
