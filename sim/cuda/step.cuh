// SPDX-License-Identifier: Apache-2.0
// The step kernel's work: every robot of a block is carried through many steps with its masses on the chip. All sums
// are integers (sim/physics/fixed_point.h), so neither the number of warps nor the other robots of the batch can change
// a bit of the result.
#pragma once

#include "sim/cuda/block_robot.cuh"
#include "sim/cuda/contacts.cuh"
#include "sim/physics/fixed_point.h"
#include "sim/physics/springs.h"

namespace mercury::cuda {

// A robot that is stepped.
template <Solver solver, class EnvironmentModel, class Memory, int record_words>
class RobotStepper : public BlockRobot<solver, Memory, record_words> {
  using Robot = BlockRobot<solver, Memory, record_words>;
  using typename Robot::Record, Robot::arguments_, Robot::record_, Robot::seat_, Robot::first_group_,
      Robot::last_group_, Robot::warps, Robot::thread, Robot::own, Robot::is_mass, Robot::offset_of, Robot::at,
      Robot::state, Robot::row_start, Robot::springs, Robot::partner_of, Robot::rest_length_of, Robot::material_of,
      Robot::unit, Robot::law_of, Robot::for_each_rows;

 public:
  __device__ RobotStepper(const StepArguments& arguments, const EnvironmentModel& model, const Seat<Memory>& seat,
                          Failure* failure, char* contacts)
      : Robot(arguments, seat), model_(model), failure_(failure), contacts_(contacts) {}

  __device__ bool alive() const { return arguments_.batch.statuses[seat_.robot].exploded_step < 0; }

  __device__ void load_lengths(float* lengths) const {
    if constexpr (record_words == 1)
      for (std::uint32_t i = thread(); i < max_lengths; i += warps() * lanes)
        lengths[i] = unit() * arguments_.batch.lengths[std::size_t{seat_.robot} * max_lengths + i];
  }

  __device__ void load_state() {
    for (std::uint32_t g = first_group_; g < last_group_; ++g) {
      const Mass<Memory> mass = own(g);
      const float* from = state(g);
      for (std::uint32_t row = 0; row < state_rows; ++row) mass.set_value(row, from[row * lanes]);
      mass.set_sum(solver == Solver::force ? springs_bias(g) : 0);
      if constexpr (solver == Solver::xpbd && Memory::keeps_splits)
        mass.set_value(row_splits, splits_of(g * lanes + seat_.lane));
    }
  }

  __device__ void store_state() const {
    for (std::uint32_t g = first_group_; g < last_group_; ++g) {
      float* to = state(g);
      for (std::uint32_t row = 0; row < state_rows; ++row) to[row * lanes] = own(g).value(row);
    }
  }
  // By thread 0.
  __device__ void store_status() const {
    if (thread() != 0 || failure_->when == never) return;
    arguments_.batch.statuses[seat_.robot] = {arguments_.clock.step + failure_->when / 4, failure_->bad_mass};
  }

  // Lists the near pairs anew; holds barriers of the block.
  __device__ void list_contacts() {
    const ContactMemory memory = contact_memory();
    travelled_ = 0;
    for (std::uint32_t b = thread(); b < buckets(); b += warps() * lanes) memory.heads[b] = end_of_list;
    if (thread() == 0) *memory.count = 0;
    __syncthreads();
    const float inverse_size = 1 / (list_radius * record_.contact_distance);
    for (std::uint32_t g = first_group_; collides() && g < last_group_; ++g) {
      if (!is_mass(g)) continue;
      const std::uint32_t mass = g * lanes + seat_.lane;
      const std::uint32_t bucket = bucket_of(cell_of(own(g).vector(row_x), inverse_size), buckets() - 1);
      memory.links[mass] = static_cast<std::uint16_t>(atomicExch(memory.heads + bucket, mass));
    }
    __syncthreads();
    if (collides())
      for_each_near_pair([&](std::uint32_t i, Vec3, std::uint32_t j) {
        if (joined(i, j)) return;
        const std::uint32_t place = atomicAdd(memory.count, 1u);
        if (place < contact_list_size) memory.pairs[place] = i << 16 | j;
      });
    __syncthreads();
  }

  // Whether the list of near pairs may have become wrong.
  __device__ bool contacts_stale() const {
    return collides() && (travelled_ > list_reach * record_.contact_distance || contact_memory().overflows());
  }

  // Contact, faces and pulls: the forces that do not depend on one mass alone.
  __device__ void add_environment(std::uint32_t step) {
    if (failed_before(step, phase_environment)) return;
    if (arguments_.batch.perturbation_count > 0 && thread() == 0) add_perturbations();
    if constexpr (EnvironmentModel::has_faces) add_faces(step);
    if constexpr (EnvironmentModel::has_contacts)
      if (collides()) add_contacts();
  }

  // Reads ahead what add_environment begins with.
  __device__ void expect_environment() {
    if constexpr (EnvironmentModel::has_faces)
      if (first_face_pair() < record_.face_pairs) first_faces_ = face_pair(first_face_pair());
  }

  // Algorithm 1's forces or Algorithm 2's corrections.
  __device__ void add_springs(std::uint32_t step) {
    if (failed_before(step, phase_springs)) return;
    const float limit = record_.squared_stretch_limit;
    // Places without a spring are measured too, and may look far.
    if (add_all_springs() > limit && longest_spring() > limit) fail(step, phase_springs, 0xffffffffu);
  }

  // XPBD: leaves the prediction in place of the position and v + dt F in place of the velocity.
  __device__ void predict(std::uint32_t step) {
    if (failed_before(step, phase_prediction)) return;
    for (std::uint32_t g = first_group_; g < last_group_; ++g) {
      if (!is_mass(g)) continue;
      const Mass<Memory> mass = own(g);
      const Vec3 v = mass.vector(row_v);
      const Vec3 force = sum_of(mass, 1 / record_.force_scale) + model_.on_mass(v);
      mass.set_sum(springs_bias(g));
      const Vec3 predicted = accelerated(v, force, arguments_.constants);
      keep(step, phase_prediction, g, multiply_add(arguments_.constants.dt, predicted, mass.vector(row_x)), predicted);
    }
  }

  __device__ void end(std::uint32_t step) {
    if (failed_before(step, phase_end)) return;
    const StepConstants& constants = arguments_.constants;
    float farthest = 0;
    for (std::uint32_t g = first_group_; g < last_group_; ++g) {
      if (!is_mass(g)) continue;
      const Mass<Memory> mass = own(g);
      Vec3 x = mass.vector(row_x), v = mass.vector(row_v);
      if constexpr (solver == Solver::force) {
        const int bias = springs_bias(g);
        v = accelerated(v, sum_of(mass, 1 / record_.force_scale) + model_.on_mass(v), constants);
        x = multiply_add(constants.dt, v, x);
        mass.set_sum(bias);
      } else {
        const Vec3 correction = sum_of(mass, 1 / record_.correction_scale);
        x = x + correction;
        v = multiply_add(constants.inverse_dt, correction, v);
        mass.set_sum(0);
      }
      end_step(x, v, model_, constants);
      if constexpr (EnvironmentModel::has_contacts) farthest = fmaxf(farthest, distance_moved(mass, x));
      keep(step, phase_end, g, x, v);
    }
    travelled_ += farthest;
  }

 private:
  __device__ std::size_t mass_index(std::uint32_t group) const {
    return (std::size_t{seat_.robot} * arguments_.batch.group_stride + group) * lanes + seat_.lane;
  }

  // The number of springs at a mass.
  __device__ float splits_of(std::uint32_t mass) const {
    const float* splits = arguments_.batch.splits + std::size_t{seat_.robot} * arguments_.batch.group_stride * lanes;
    return __ldg(splits + mass);
  }
  __device__ float own_splits(std::uint32_t group, const Mass<Memory>& mass) const {
    if constexpr (solver == Solver::force)
      return 0;
    else if constexpr (Memory::keeps_splits)
      return mass.value(row_splits);
    else
      return splits_of(group * lanes + seat_.lane);
  }
  __device__ float partner_splits(const Record& record, const Mass<Memory>& partner) const {
    if constexpr (Memory::keeps_splits)
      return partner.value(row_splits);
    else
      return splits_of(slot_at(record.x >> 16, Robot::rows));
  }

  // What every spring that ends at a mass adds to its sum besides its force: the bits of the rounding constant.
  __device__ int springs_bias(std::uint32_t group) const {
    return -static_cast<int>(__ldg(arguments_.batch.arrivals + mass_index(group))) * rounding_magic_bits;
  }

  __device__ bool failed_before(std::uint32_t step, Phase phase) const {
    return *static_cast<volatile std::uint32_t*>(&failure_->when) < 4 * step + phase;
  }
  __device__ void fail(std::uint32_t step, Phase phase, std::uint32_t mass) {
    atomicMin(&failure_->when, 4 * step + phase);
    atomicMin(&failure_->bad_mass, mass);
  }

  // At least how far a mass goes in this step; where it is now, XPBD has its prediction and its predicted velocity.
  __device__ float distance_moved(const Mass<Memory>& mass, Vec3 x) const {
    float moved = sqrtf(squared_length(x - mass.vector(row_x)));
    if constexpr (solver == Solver::xpbd) moved += arguments_.constants.dt * sqrtf(squared_length(mass.vector(row_v)));
    return moved;
  }

  __device__ static Vec3 sum_of(const Mass<Memory>& mass, float inverse_scale) {
    return {static_cast<float>(mass.sum(0)) * inverse_scale, static_cast<float>(mass.sum(1)) * inverse_scale,
            static_cast<float>(mass.sum(2)) * inverse_scale};
  }

  // Stores a mass's new state unless it left the finite; then the mass stays and the robot has exploded.
  __device__ void keep(std::uint32_t step, Phase phase, std::uint32_t group, Vec3 x, Vec3 v) {
    if (within_reach(x)) {
      own(group).set_vector(row_x, x);
      own(group).set_vector(row_v, v);
    } else {
      fail(step, phase, slot_order(record_).mass_of(group * lanes + seat_.lane));
    }
  }

  // A mass while its springs are met: where it is, and minus what they add to it.
  struct Owner {
    Vec3 x;
    float splits;
    int sum_x, sum_y, sum_z;
  };

  // `count` rows of springs: first every load, then the arithmetic, then every addition.
  template <int count>
  __device__ void add_rows(const Record* records, Owner& owner, float& longest) const {
    Mass<Memory> partner[count];
    Vec3 d[count];
    float2 law[count];
    float splits[count], rest_length[count];
#pragma unroll
    for (int i = 0; i < count; ++i) {
      partner[i] = partner_of(records[i]);
      rest_length[i] = rest_length_of(records[i]);
      d[i] = owner.x - partner[i].vector(row_x);
      law[i] = law_of(records[i]);
      if constexpr (solver == Solver::xpbd) splits[i] = owner.splits + partner_splits(records[i], partner[i]);
    }
#pragma unroll
    for (int i = 0; i < count; ++i) {
      const float squared = squared_length(d[i]);
      longest = fmaxf(longest, squared);
      const float length = rest_length[i] * law[i].y;
      float per_distance;
      if constexpr (solver == Solver::force)
        per_distance = hooke(squared, length, law[i].x, unit());
      else
        per_distance = xpbd(squared, length, splits[i], law[i].x, unit());
      const int x = bits_of(multiply_add(per_distance, d[i].x, rounding_magic));
      const int y = bits_of(multiply_add(per_distance, d[i].y, rounding_magic));
      const int z = bits_of(multiply_add(per_distance, d[i].z, rounding_magic));
      owner.sum_x -= x;
      owner.sum_y -= y;
      owner.sum_z -= z;
      partner[i].add_to_sum(x, y, z);
    }
  }

  // All springs of this warp's masses. Returns the longest |d|^2.
  __device__ float add_all_springs() const {
    float longest = 0;
    for_each_rows(
        [&](std::uint32_t group, const Mass<Memory>& mass, std::uint32_t rows_owned) {
          const int bias = static_cast<int>(rows_owned) * rounding_magic_bits;
          return Owner{mass.vector(row_x), own_splits(group, mass), bias, bias, bias};
        },
        [&](auto count, const Record* records, Owner& owner) {
          add_rows<decltype(count)::value>(records, owner, longest);
        },
        [](const Mass<Memory>& mass, const Owner& owner) { mass.add_to_sum(owner.sum_x, owner.sum_y, owner.sum_z); });
    return longest;
  }

  // The last warps begin, since the first ones have the material table to look after.
  __device__ std::uint32_t first_face_pair() const { return (warps() - 1 - seat_.warp) * lanes + seat_.lane; }
  __device__ ushort4 face_pair(std::uint32_t p) const {
    const FacePair* pairs = arguments_.batch.face_pairs + std::size_t{seat_.robot} * arguments_.batch.face_stride;
    return __ldg(reinterpret_cast<const ushort4*>(pairs + p));
  }

  // The longest |d|^2 of this lane's springs.
  __device__ float longest_spring() const {
    float longest = 0;
    for (std::uint32_t g = first_group_; g < last_group_; ++g)
      for (std::uint32_t row = row_start()[g]; row < row_start()[g + 1]; ++row) {
        const Record record = springs()[std::size_t{row} * lanes + seat_.lane];
        if (material_of(record) == air) continue;
        longest = fmaxf(longest, squared_length(own(g).vector(row_x) - partner_of(record).vector(row_x)));
      }
    return longest;
  }

  __device__ void add_faces(std::uint32_t step) {
    ushort4 next = first_faces_;
    for (std::uint32_t p = first_face_pair(); p < record_.face_pairs; p += warps() * lanes) {
      const ushort4 corner = next;
      if (p + warps() * lanes < record_.face_pairs) next = face_pair(p + warps() * lanes);
      if (corner.x == corner.y) continue;  // an empty place
      const Mass<Memory> a = at(corner.x), b = at(corner.y), c = at(corner.z), d = at(corner.w);
      const Vec3 xa = a.vector(row_x);
      const Vec3 to_b = b.vector(row_x) - xa, to_c = c.vector(row_x) - xa, to_d = d.vector(row_x) - xa;
      const Vec3 shared = a.vector(row_v) + c.vector(row_v);
      const float third = 1.0f / 3.0f;
      const float scale = third * record_.force_scale;
      const Vec3 first = scale * model_.on_face(0.5f * cross(to_b, to_c), third * (shared + b.vector(row_v)));
      const Vec3 second = scale * model_.on_face(0.5f * cross(to_c, to_d), third * (shared + d.vector(row_v)));
      if (!fits(first) || !fits(second)) {
        const SlotOrder order = slot_order(record_);
        fail(step, phase_environment,
             min(min(order.mass_of(corner.x), order.mass_of(corner.y)),
                 min(order.mass_of(corner.z), order.mass_of(corner.w))));
        continue;
      }
      const int x1 = round_to_int(first.x), y1 = round_to_int(first.y), z1 = round_to_int(first.z);
      const int x2 = round_to_int(second.x), y2 = round_to_int(second.y), z2 = round_to_int(second.z);
      b.add_to_sum(x1, y1, z1);
      d.add_to_sum(x2, y2, z2);
      a.add_to_sum(x1 + x2, y1 + y2, z1 + z2);
      c.add_to_sum(x1 + x2, y1 + y2, z1 + z2);
    }
  }

  __device__ void add_perturbations() {
    for (std::uint32_t p = 0; p < arguments_.batch.perturbation_count; ++p) {
      const DevicePerturbation& perturbation = arguments_.batch.perturbations[p];
      if (perturbation.robot != seat_.robot) continue;
      const Vec3 units =
          perturbation.stiffness * record_.force_scale * (perturbation.target - at(perturbation.slot).vector(row_x));
      if (fits(units)) at(perturbation.slot).add_to_sum(units);
    }
  }

  __device__ std::uint32_t buckets() const { return arguments_.shape.contact_buckets; }
  __device__ bool collides() const { return buckets() > 0 && record_.contact_distance > 0; }
  __device__ ContactMemory contact_memory() const { return {contacts_, buckets()}; }

  // visit(i, x_i, j) for every pair within list_radius of which i is one of this warp's masses.
  template <class Visit>
  __device__ void for_each_near_pair(const Visit& visit) const {
    const auto position = [&](std::uint32_t j) { return at(j).vector(row_x); };
    for (std::uint32_t g = first_group_; g < last_group_; ++g) {
      if (!is_mass(g)) continue;
      const std::uint32_t i = g * lanes + seat_.lane;
      const Vec3 x = own(g).vector(row_x);
      for_each_near(contact_memory(), buckets(), record_.contact_distance, i, x, position,
                    [&](std::uint32_t j) { visit(i, x, j); });
    }
  }

  __device__ void add_contacts() const {
    const ContactMemory memory = contact_memory();
    if (memory.overflows()) {
      for_each_near_pair([&](std::uint32_t i, Vec3 x, std::uint32_t j) {
        if (touches(at(j).vector(row_x) - x) && !joined(i, j)) add_contact(i, j);
      });
      return;
    }
    const std::uint32_t count = *memory.count;
    for (std::uint32_t p = thread(); p < count; p += warps() * lanes)
      add_contact(memory.pairs[p] >> 16, memory.pairs[p] & 0xffff);
  }

  __device__ bool touches(Vec3 d) const {
    return squared_length(d) < record_.contact_distance * record_.contact_distance;
  }

  __device__ void add_contact(std::uint32_t i, std::uint32_t j) const {
    const Vec3 d = at(j).vector(row_x) - at(i).vector(row_x);
    if (!touches(d)) return;
    const float stiffness = arguments_.contact_stiffness * record_.force_scale;
    const Vec3 units = repulsion(squared_length(d), record_.contact_distance, stiffness) * d;
    at(i).add_to_sum(units);
    at(j).add_to_sum(-units);
  }

  __device__ bool joined(std::uint32_t i, std::uint32_t j) const { return owns(i, j) || owns(j, i); }

  // Whether mass i owns a spring to mass j.
  __device__ bool owns(std::uint32_t i, std::uint32_t j) const {
    const std::uint32_t wanted = Memory::on_chip ? offset_of(j) / 4 : j, group = i / lanes;
    const Record* spring = springs() + i % lanes;
    for (std::uint32_t row = row_start()[group]; row < row_start()[group + 1]; ++row) {
      const std::uint32_t key = spring[std::size_t{row} * lanes].x;
      if (key >> 16 == wanted && (key & 0xff) != air) return true;
    }
    return false;
  }

  const EnvironmentModel& model_;
  float travelled_ = 0;  // no mass of this thread has gone farther since contacts were listed
  ushort4 first_faces_{};
  Failure* const failure_;
  char* const contacts_;
};

}  // namespace mercury::cuda
