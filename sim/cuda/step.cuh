// The step kernel: every robot of a block is carried through many steps with its masses on the chip.
//
// A block steps `robots_per_block` robots side by side; each has `warps_per_robot` warps, which share its groups of 32
// masses among them. All sums are integers (sim/fixed_point.h), so neither the number of warps nor the other robots of
// the batch can change a bit of the result.
#pragma once

#include "sim/contact.h"
#include "sim/cuda/block.cuh"
#include "sim/fixed_point.h"
#include "sim/springs.h"

namespace mercury::cuda {

__device__ inline float& float_at(char* base, std::uint32_t bytes) { return *reinterpret_cast<float*>(base + bytes); }
__device__ inline int& int_at(char* base, std::uint32_t bytes) { return *reinterpret_cast<int*>(base + bytes); }

__device__ inline Vec3 load(char* mass, std::uint32_t row) {
  return {float_at(mass, row * row_bytes), float_at(mass, (row + 1) * row_bytes), float_at(mass, (row + 2) * row_bytes)};
}
__device__ inline void store(char* mass, std::uint32_t row, Vec3 value) {
  float_at(mass, row * row_bytes) = value.x;
  float_at(mass, (row + 1) * row_bytes) = value.y;
  float_at(mass, (row + 2) * row_bytes) = value.z;
}

__device__ inline void add_to_sum(char* mass, int x, int y, int z) {
  atomicAdd(&int_at(mass, row_sum * row_bytes), x);
  atomicAdd(&int_at(mass, (row_sum + 1) * row_bytes), y);
  atomicAdd(&int_at(mass, (row_sum + 2) * row_bytes), z);
}
__device__ inline void add_to_sum(char* mass, Vec3 units) {
  add_to_sum(mass, round_to_int(units.x), round_to_int(units.y), round_to_int(units.z));
}

// One robot of a block, as one of its threads sees it.
template <Solver solver, class Hooks>
class RobotStepper {
 public:
  static constexpr std::uint32_t rows = solver == Solver::force ? working_rows_force : working_rows_xpbd;
  static constexpr std::uint32_t group_bytes = rows * row_bytes;

  __device__ RobotStepper(const StepArguments& arguments, const Hooks& hooks, std::uint32_t robot, std::uint32_t warp,
                          std::uint32_t lane, char* masses, SpringLaw* table, Failure* failure, char* contacts)
      : arguments_(arguments), hooks_(hooks), record_(arguments.batch.robots[robot]), robot_(robot), warp_(warp),
        lane_(lane), masses_(masses), table_(table), failure_(failure) {
    const BatchView& batch = arguments.batch;
    springs_ = batch.springs + std::size_t{robot} * batch.row_stride * lanes + lane;
    row_start_ = batch.row_start + std::size_t{robot} * (batch.group_stride + 1);
    face_pairs_ = batch.face_pairs + std::size_t{robot} * batch.face_stride;
    state_ = batch.state + std::size_t{robot} * batch.group_stride * state_rows * lanes + lane;
    heads_ = reinterpret_cast<std::uint32_t*>(contacts);
    next_heads_ = heads_ + arguments.shape.contact_buckets;
    links_ = reinterpret_cast<std::uint16_t*>(next_heads_ + arguments.shape.contact_buckets);
  }

  __device__ bool alive() const { return arguments_.batch.statuses[robot_].exploded_step < 0; }

  __device__ void load_state() {
    for (std::uint32_t g = warp_; g < record_.groups; g += warps()) {
      char* mass = own(g);
      const float* from = state_ + std::size_t{g} * state_rows * lanes;
      for (std::uint32_t row = 0; row < state_rows; ++row) float_at(mass, row * row_bytes) = from[row * lanes];
      for (std::uint32_t row = 0; row < 3; ++row) int_at(mass, (row_sum + row) * row_bytes) = 0;
      if constexpr (solver == Solver::xpbd) {
        const float springs = arguments_.batch.splits[std::size_t{robot_} * arguments_.batch.group_stride * lanes + g * lanes + lane_];
        float_at(mass, row_splits * row_bytes) = springs / record_.correction_scale;
      }
    }
  }

  // Every mass into the buckets of the first step; holds a barrier of the block.
  __device__ void fill_contacts() {
    for (std::uint32_t b = thread(); b < 2 * arguments_.shape.contact_buckets; b += warps() * lanes) heads_[b] = end_of_list;
    __syncthreads();
    if (!collides()) return;
    for (std::uint32_t g = warp_; g < record_.groups; g += warps())
      if (is_mass(g)) link(g, load(own(g), row_x), heads_);
  }

  __device__ void store_state() {
    for (std::uint32_t g = warp_; g < record_.groups; g += warps()) {
      char* mass = own(g);
      float* to = state_ + std::size_t{g} * state_rows * lanes;
      for (std::uint32_t row = 0; row < state_rows; ++row) to[row * lanes] = float_at(mass, row * row_bytes);
    }
    if (thread() == 0 && failure_->when != never) {
      arguments_.batch.statuses[robot_].exploded_step = arguments_.clock.step + failure_->when / 4;
      arguments_.batch.statuses[robot_].bad_mass = failure_->bad_mass;
    }
  }

  // Contact, faces and pulls: the forces that do not depend on one mass alone.
  __device__ void add_environment(std::uint32_t step) {
    if (failed_before(step, phase_environment)) return;
    if (arguments_.batch.pull_count > 0 && thread() == 0) add_pulls();
    if constexpr (Hooks::has_faces) add_faces(step);
    if constexpr (Hooks::has_contacts)
      if (collides()) add_contacts();
  }

  // Algorithm 1's forces or Algorithm 2's corrections.
  __device__ void add_springs(std::uint32_t step) {
    if (failed_before(step, phase_springs)) return;
    float longest = 0;
    for (std::uint32_t g = warp_; g < record_.groups; g += warps()) longest = fmaxf(longest, add_group(g));
    if (longest > record_.squared_stretch_limit) fail(step, phase_springs, 0xffffffffu);
  }

  // XPBD: leaves the prediction in place of the position and v + dt F in place of the velocity.
  __device__ void predict(std::uint32_t step) {
    if (failed_before(step, phase_prediction)) return;
    for (std::uint32_t g = warp_; g < record_.groups; g += warps()) {
      if (!is_mass(g)) continue;
      char* mass = own(g);
      const Vec3 v = load(mass, row_v);
      const Vec3 predicted = accelerated(v, take_sum(mass, 1 / record_.force_scale) + hooks_.on_mass(v), arguments_.constants);
      keep(step, phase_prediction, g, multiply_add(arguments_.constants.dt, predicted, load(mass, row_x)), predicted);
    }
  }

  __device__ void end(std::uint32_t step) {
    if (failed_before(step, phase_end)) return;
    const StepConstants& constants = arguments_.constants;
    for (std::uint32_t g = warp_; g < record_.groups; g += warps()) {
      if (!is_mass(g)) continue;
      char* mass = own(g);
      Vec3 x = load(mass, row_x), v = load(mass, row_v);
      if constexpr (solver == Solver::force) {
        v = accelerated(v, take_sum(mass, 1 / record_.force_scale) + hooks_.on_mass(v), constants);
        x = multiply_add(constants.dt, v, x);
      } else {
        const Vec3 correction = take_sum(mass, 1 / record_.correction_scale);
        x = x + correction;
        v = multiply_add(constants.inverse_dt, correction, v);
      }
      end_step(x, v, hooks_, constants);
      keep(step, phase_end, g, x, v);
      if constexpr (Hooks::has_contacts)
        if (collides()) link(g, load(mass, row_x), next_heads_);
    }
  }

  // Between two steps: the buckets just filled become the ones to read.
  __device__ void turn_contacts() {
    if constexpr (Hooks::has_contacts) {
      std::uint32_t* filled = next_heads_;
      next_heads_ = heads_;
      heads_ = filled;
    }
  }

 private:
  __device__ std::uint32_t warps() const { return arguments_.shape.warps_per_robot; }
  __device__ std::uint32_t thread() const { return warp_ * lanes + lane_; }
  __device__ char* own(std::uint32_t group) const { return masses_ + group * group_bytes + lane_ * 4; }
  __device__ bool is_mass(std::uint32_t group) const { return group * lanes + lane_ < record_.masses; }
  __device__ char* at(std::uint32_t mass) const { return masses_ + mass / lanes * group_bytes + mass % lanes * 4; }
  __device__ bool collides() const { return arguments_.shape.contact_buckets > 0 && record_.contact_distance > 0; }

  __device__ bool failed_before(std::uint32_t step, Phase phase) const {
    return *static_cast<volatile std::uint32_t*>(&failure_->when) < 4 * step + phase;
  }
  __device__ void fail(std::uint32_t step, Phase phase, std::uint32_t mass) {
    atomicMin(&failure_->when, 4 * step + phase);
    atomicMin(&failure_->bad_mass, mass);
  }

  __device__ Vec3 take_sum(char* mass, float inverse_scale) const {
    Vec3 sum;
    sum.x = static_cast<float>(int_at(mass, row_sum * row_bytes)) * inverse_scale;
    sum.y = static_cast<float>(int_at(mass, (row_sum + 1) * row_bytes)) * inverse_scale;
    sum.z = static_cast<float>(int_at(mass, (row_sum + 2) * row_bytes)) * inverse_scale;
    int_at(mass, row_sum * row_bytes) = 0;
    int_at(mass, (row_sum + 1) * row_bytes) = 0;
    int_at(mass, (row_sum + 2) * row_bytes) = 0;
    return sum;
  }

  // Stores a mass's new state unless it left the finite; then the mass stays and the robot has exploded.
  __device__ void keep(std::uint32_t step, Phase phase, std::uint32_t group, Vec3 x, Vec3 v) {
    if (within_reach(x)) {
      store(own(group), row_x, x);
      store(own(group), row_v, v);
    } else {
      fail(step, phase, group * lanes + lane_);
    }
  }

  // The springs of a group's masses. Returns the longest |d|^2.
  __device__ float add_group(std::uint32_t group) {
    char* mass = own(group);
    const Vec3 x = load(mass, row_x);
    const float splits = solver == Solver::xpbd ? float_at(mass, row_splits * row_bytes) : 0.0f;
    const std::uint32_t first = row_start_[group], last = row_start_[group + 1];
    const char* table = reinterpret_cast<const char*>(table_);
    const std::uint32_t law_bytes = static_cast<std::uint32_t>(sizeof(SpringLaw)) * arguments_.shape.table_copies;
    float longest = 0;
    int sum_x = 0, sum_y = 0, sum_z = 0;
#pragma unroll 4
    for (std::uint32_t row = first; row < last; ++row) {
      const uint2 bits = __ldg(reinterpret_cast<const uint2*>(springs_ + std::size_t{row} * lanes));
      char* partner = masses_ + (bits.x >> 8);
      const float2 law = *reinterpret_cast<const float2*>(table + (bits.x & 0xff) * law_bytes);
      const Vec3 d = load(partner, row_x) - x;
      const float squared = squared_length(d);
      longest = fmaxf(longest, squared);
      const float length = __uint_as_float(bits.y) * law.y;
      float per_distance;
      if constexpr (solver == Solver::force)
        per_distance = hooke(squared, length, law.x);
      else
        per_distance = xpbd(squared, length, splits + float_at(partner, row_splits * row_bytes), law.x);
      const int fx = to_fixed_small(per_distance, d.x), fy = to_fixed_small(per_distance, d.y),
                fz = to_fixed_small(per_distance, d.z);
      sum_x += fx;
      sum_y += fy;
      sum_z += fz;
      add_to_sum(partner, -fx, -fy, -fz);
    }
    add_to_sum(mass, sum_x, sum_y, sum_z);
    return longest;
  }

  __device__ void add_faces(std::uint32_t step) {
    for (std::uint32_t p = thread(); p < record_.face_pairs; p += warps() * lanes) {
      const ushort4 corner = __ldg(reinterpret_cast<const ushort4*>(face_pairs_ + p));
      char *const a = at(corner.x), *const b = at(corner.y), *const c = at(corner.z), *const d = at(corner.w);
      const Vec3 xa = load(a, row_x);
      const Vec3 to_b = load(b, row_x) - xa, to_c = load(c, row_x) - xa, to_d = load(d, row_x) - xa;
      const Vec3 shared = load(a, row_v) + load(c, row_v);
      const float third = 1.0f / 3.0f;
      const float scale = third * record_.force_scale;
      const Vec3 first = scale * hooks_.on_face(0.5f * cross(to_b, to_c), third * (shared + load(b, row_v)));
      const Vec3 second = scale * hooks_.on_face(0.5f * cross(to_c, to_d), third * (shared + load(d, row_v)));
      if (!fits(first) || !fits(second)) {
        fail(step, phase_environment, min(min(corner.x, corner.y), min(corner.z, corner.w)));
        continue;
      }
      const int x1 = round_to_int(first.x), y1 = round_to_int(first.y), z1 = round_to_int(first.z);
      const int x2 = round_to_int(second.x), y2 = round_to_int(second.y), z2 = round_to_int(second.z);
      add_to_sum(b, x1, y1, z1);
      add_to_sum(d, x2, y2, z2);
      add_to_sum(a, x1 + x2, y1 + y2, z1 + z2);
      add_to_sum(c, x1 + x2, y1 + y2, z1 + z2);
    }
  }

  __device__ void add_pulls() {
    for (std::uint32_t p = 0; p < arguments_.batch.pull_count; ++p) {
      const DevicePull& pull = arguments_.batch.pulls[p];
      if (pull.robot != robot_) continue;
      const Vec3 units = pull.stiffness * record_.force_scale * (pull.target - load(at(pull.mass), row_x));
      if (fits(units)) add_to_sum(at(pull.mass), units);
    }
  }

  __device__ void link(std::uint32_t group, Vec3 x, std::uint32_t* heads) {
    const std::uint32_t mass = group * lanes + lane_;
    const std::uint32_t bucket =
        bucket_of(cell_of(x, 1 / record_.contact_distance), arguments_.shape.contact_buckets - 1);
    links_[mass] = static_cast<std::uint16_t>(atomicExch(heads + bucket, mass));
  }

  __device__ void add_contacts() {
    const std::uint32_t mask = arguments_.shape.contact_buckets - 1;
    for (std::uint32_t b = thread(); b <= mask; b += warps() * lanes) next_heads_[b] = end_of_list;
    const float inverse_size = 1 / record_.contact_distance;
    for (std::uint32_t g = warp_; g < record_.groups; g += warps()) {
      if (!is_mass(g)) continue;
      const std::uint32_t i = g * lanes + lane_;
      const Vec3 x = load(own(g), row_x);
      const Cell cell = cell_of(x, inverse_size);
#pragma unroll 2
      for (int n = 0; n < half_neighbourhood; ++n) {
        const Cell other = neighbour_cell(cell, n);
        for (std::uint32_t j = heads_[bucket_of(other, mask)]; j != end_of_list; j = links_[j])
          if ((n > 0 || j > i) && cell_of(load(at(j), row_x), inverse_size) == other) add_contact(g, x, j);
      }
    }
  }

  __device__ void add_contact(std::uint32_t group, Vec3 x, std::uint32_t j) {
    const Vec3 d = load(at(j), row_x) - x;
    const float squared = squared_length(d);
    const float distance = record_.contact_distance;
    if (!(squared < distance * distance) || joined(group * lanes + lane_, j)) return;
    const Vec3 units = repulsion(squared, distance, arguments_.contact_stiffness * record_.force_scale) * d;
    add_to_sum(own(group), units);
    add_to_sum(at(j), -units);
  }

  __device__ bool joined(std::uint32_t i, std::uint32_t j) const { return owns(i, j) || owns(j, i); }

  // Whether mass i owns a spring to mass j.
  __device__ bool owns(std::uint32_t i, std::uint32_t j) const {
    const auto wanted = static_cast<std::uint32_t>(at(j) - masses_);
    const std::uint32_t group = i / lanes;
    const SpringRecord* spring = springs_ - lane_ + i % lanes;
    for (std::uint32_t row = row_start_[group]; row < row_start_[group + 1]; ++row) {
      const SpringRecord& record = spring[std::size_t{row} * lanes];
      if (record.where >> 8 == wanted && (record.where & 0xff) != air) return true;
    }
    return false;
  }

  const StepArguments& arguments_;
  const Hooks& hooks_;
  const RobotRecord record_;
  const std::uint32_t robot_, warp_, lane_;
  char* const masses_;
  SpringLaw* const table_;
  Failure* const failure_;
  const SpringRecord* springs_;
  const std::uint32_t* row_start_;
  const FacePair* face_pairs_;
  float* state_;
  std::uint32_t *heads_, *next_heads_;
  std::uint16_t* links_;
};

}  // namespace mercury::cuda
