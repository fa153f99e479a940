// SPDX-License-Identifier: Apache-2.0
// A thought of a brain (mercury/brain.h), between two steps, by the warps of its robot:
//
//   measure   each warp     sums over a share of the masses or springs            -> sums
//   -- barrier of the robot's warps, as after each of the following --
//   conclude  each warp     a place from its sums, or the frame, or the turn rate -> measures
//   sense     each thread   one sense                                             -> samples, values
//   update    8 lanes each  the sum of one neuron after the other
//             each thread   one neuron, one weight that learns                    -> values, activations, weights
//   drive     each thread   one output, one driven material                       -> drives, materials, their table
//
// The order of every sum depends only on the robot, not on its number of warps. A thought is a chain of short sums,
// whose time is that of its accesses and instructions. So all that it reads lies in the brain's memory from the
// beginning of the launch on (brain_tables.h), and what it stores to device memory is not waited for.
#pragma once

#include <cmath>
#include <cstddef>

#include "mercury/shared_array.h"
#include "sim/cuda/material_table.cuh"
#include "sim/cuda/thread_context.cuh"
#include "sim/physics/activation.h"
#include "sim/physics/actuation.h"

namespace mercury::cuda {

// Sums of 2, 4, 8 or 16 values over the lanes of a warp. Lanes exchange halves of what they have, so that lanes 2 i and
// 2 i + 1 have the sum of the i-th of 16 values in the end. (A loop over halves put the values into local memory.)
template <unsigned count>
__device__ float sums_of_warp(const float (&values)[count]) {
  constexpr unsigned half = count / 2;
  const bool upper = threadIdx.x & count;
  float sums[half];
#pragma unroll
  for (unsigned i = 0; i < half; ++i) {
    const float give = upper ? values[i] : values[i + half], keep = upper ? values[i + half] : values[i];
    sums[i] = keep + __shfl_xor_sync(0xffffffffu, give, count);
  }
  if constexpr (half > 1)
    return sums_of_warp(sums);
  else
    return sums[0] + __shfl_xor_sync(0xffffffffu, sums[0], 1);
}

// The memory of a robot's brain: on the chip, beside the robot's masses, or in device memory, as they are. So the
// compiler knows which. `at` = BlockContext::brain.
template <class Memory>
__device__ char* brain_memory(const StepArguments& arguments, std::uint32_t at, std::uint32_t place) {
  const Thoughts& thoughts = arguments.thoughts;
  if constexpr (Memory::on_chip)
    return shared_memory + at;
  else
    return thoughts.workspace + std::size_t{thoughts.thinkers[place]} * thoughts.workspace_stride;
}

template <class T>
__device__ T* part_of(const char* memory, std::uint32_t offset) {
  return reinterpret_cast<T*>(const_cast<char*>(memory) + offset);
}

// All warps of a robot that has a brain call this once per launch; complete_brain() follows after a barrier.
template <class Memory>
__device__ __noinline__ void load_brain(const StepArguments& arguments, std::uint32_t at, std::uint32_t place,
                                        std::uint32_t warp) {
  char* const memory = brain_memory<Memory>(arguments, at, place);
  const Thoughts& thoughts = arguments.thoughts;
  const ThinkingRobot& from = thoughts.robots[thoughts.thinkers[place]];
  const BrainBytes& room = arguments.launch.brain;
  const std::uint32_t thread = warp * lanes + threadIdx.x % lanes, threads = arguments.launch.warps_per_robot * lanes;
  const auto copy = [&]<class T>(T* to, const T* list, std::uint32_t count) {
#pragma unroll 1
    for (std::uint32_t i = thread; i < count; i += threads) to[i] = list[i];
  };
  const auto copy_bytes = [&](char* to, const char* list, std::uint32_t bytes) {
    copy(reinterpret_cast<uint4*>(to), reinterpret_cast<const uint4*>(list), bytes / sizeof(uint4));
  };
  copy(part_of<std::uint32_t>(memory, 0), reinterpret_cast<const std::uint32_t*>(&from), sizeof(from) / 4);
  copy(part_of<float>(memory, from.at.values) + from.senses, static_cast<const float*>(from.activations), from.neurons);
  copy(part_of<float>(memory, from.at.clamps), from.clamps, from.neurons);
  char* const plan = memory + room.scratch;
  char* const body = plan + from.plan_bytes;
  float* const weights = part_of<float>(plan, room.tables);
  const std::uint32_t measures = sizeof(BodyMeasures) + from.places * sizeof(PlaceMeasures);
#pragma unroll 1
  for (std::uint32_t i = thread; i < measures / sizeof(double); i += threads)
    part_of<double>(memory, from.at.measures)[i] = 0;
  if (room.tables > 0) copy_bytes(plan, from.plan, from.plan_bytes), copy_bytes(body, from.body, from.body_bytes);
  if (room.weights > 0) copy(weights, static_cast<const float*>(from.stored_weights), from.weight_count);
  const ActuationSources& sources = thoughts.sources;
#pragma unroll 1
  for (std::uint32_t i = thread; i < from.materials; i += threads) {
    const BrainMaterial source = from.material_sources[i];
    const bool driven = source.neuron != BrainPlan::none && sources.driven[source.setting] != held_drive;
    part_of<BrainMuscle>(memory, from.at.muscles)[i] = {
        driven ? actuated_amplitude(*source.own, sources.amplitude[source.setting]) : 0,
        driven ? source.neuron : BrainPlan::none};
  }
}

// One thread of the robot calls this. A barrier follows.
template <class Memory>
__device__ __noinline__ void complete_brain(const StepArguments& arguments, std::uint32_t at, std::uint32_t place) {
  char* const memory = brain_memory<Memory>(arguments, at, place);
  const Thoughts& thoughts = arguments.thoughts;
  const ThinkingRobot& from = thoughts.robots[thoughts.thinkers[place]];
  const BrainBytes& room = arguments.launch.brain;
  char* const plan = memory + room.scratch;
  char* const body = plan + from.plan_bytes;
  float* const weights = part_of<float>(plan, room.tables);
  ThinkingRobot& head = *part_of<ThinkingRobot>(memory, 0);
  if (room.tables > 0) head.plan = plan, head.body = body;
  if (room.weights > 0) head.weights = weights;
  head.world = thoughts.world;
  if (const Vec3 target = *from.target; !std::isnan(target.x)) head.world.target = target;
  head.thought = *from.thoughts;
  head.steps_per_thought = steps_per_thought(from.period, arguments.clock.dt);
  head.seed = from.seed + *from.noise_seed;
  const BatchView& batch = arguments.batch;
  if (batch.point_masses) head.point_masses = batch.point_masses + std::size_t{place} * batch.tile_stride * lanes;
  head.mass = batch.robots[place].mass;
  head.masses = batch.robots[place].masses;
}

// A robot of a block as its brain sees it.
template <Solver solver_, class Memory_>
struct ThinkingBody {
  static constexpr Solver solver = solver_;
  using Memory = Memory_;
  const StepArguments& arguments;
  char* brain;
  typename Memory::Address masses;  // of slot 0
  SpringParameters<solver>* material_table;
  std::uint32_t* moving;  // of MaterialTable
  SplitBarrier barrier;   // of the robot's warps
  std::uint32_t place, warp, lane, warps;
  std::uint32_t step;  // of the launch

  __device__ std::uint32_t threads() const { return warps * lanes; }
  __device__ std::uint32_t thread() const { return warp * lanes + lane; }
  __device__ Mass<Memory> mass_at(std::uint32_t slot) const {
    constexpr std::uint32_t tile_bytes = working_fields(solver, Memory::keeps_valence) * field_bytes;
    return {masses + (slot / lanes * tile_bytes + slot % lanes * 4)};
  }
};

template <class Body>
class Thought {
 public:
  using Memory = typename Body::Memory;

  __device__ explicit Thought(const Body& robot)
      : robot_(robot), of_(*part_of<ThinkingRobot>(robot.brain, 0)), z_(part_of<float>(robot.brain, of_.at.values)) {}

  __device__ void think() const {
    const std::uint32_t shares = of_.tile_shares + of_.listed_shares;
    if (shares > 0) {
#pragma unroll 1
      for (std::uint32_t share = robot_.warp; share < shares; share += robot_.warps)
        if (share < of_.tile_shares)
          measure_tiles(share);
        else
          measure_list(body_part<SensingShare>(of_.at.shares)[share - of_.tile_shares]);
      wait();
#pragma unroll 1
      for (std::uint32_t task = robot_.warp; task < conclusions(); task += robot_.warps) conclude(task);
      wait();
    }
    sense();
    wait();
#pragma unroll 1
    for (std::uint32_t layer = 0; layer < of_.layers; ++layer)
      update(plan_part<BrainPlan::Layer>(of_.at.layers)[layer]);
    drive();
  }

 private:
  // No named barrier: with one, a block would take them all, and a multiprocessor would have room for four blocks.
  __device__ void wait() const {
    if constexpr (!SplitBarrier::exists) return wait_for_robot(number_in_block(robot_.arguments.launch), robot_.warps);
    __syncwarp();
    if (robot_.lane == 0) robot_.barrier.arrive_and_wait();
    __syncwarp();
  }
  template <class T>
  __device__ const T* plan_part(std::uint32_t offset) const {
    return part_of<const T>(of_.plan, offset);
  }
  template <class T>
  __device__ const T* body_part(std::uint32_t offset) const {
    return part_of<const T>(of_.body, offset);
  }
  __device__ float* row_of_sums(std::uint32_t row) const {
    return part_of<float>(robot_.brain, of_.at.sums) + row * sums_per_row;
  }
  __device__ BodyMeasures& body_measures() const { return *part_of<BodyMeasures>(robot_.brain, of_.at.measures); }
  __device__ PlaceMeasures& place_measures(std::uint32_t number) const {
    return part_of<PlaceMeasures>(robot_.brain, of_.at.measures + sizeof(BodyMeasures))[number];
  }
  __device__ void measure_list(const SensingShare& share) const {
    if (share.of_springs)
      measure_springs(share, row_of_sums(share.row));
    else
      measure_masses(share, row_of_sums(share.row));
  }

  // m d, m v, and masses on the ground, of the few masses that a lane has: rounding is that of the positions.
  struct MassSums {
    Vec3 md, mv;
    float touching = 0;

    __device__ void add(float m, Vec3 d, Vec3 v, float z) {
      md = multiply_add(m, d, md);
      mv = multiply_add(m, v, mv);
      if (on_ground(z)) touching += 1;
    }
    __device__ void to(float* sums) const {
      const float all[] = {md.x, md.y, md.z, mv.x, mv.y, mv.z, touching};
#pragma unroll
      for (int i = 0; i < 7; ++i) sums[i] = all[i];
    }
  };
  // m d x v and m d d^T.
  struct TurningSums {
    Vec3 momentum, squares, products;

    __device__ void add(float m, Vec3 d, Vec3 v) {
      const Vec3 md = m * d;
      momentum = {fmaf(md.y, v.z, fmaf(-md.z, v.y, momentum.x)), fmaf(md.z, v.x, fmaf(-md.x, v.z, momentum.y)),
                  fmaf(md.x, v.y, fmaf(-md.y, v.x, momentum.z))};
      squares = {fmaf(md.x, d.x, squares.x), fmaf(md.y, d.y, squares.y), fmaf(md.z, d.z, squares.z)};
      products = {fmaf(md.x, d.y, products.x), fmaf(md.x, d.z, products.y), fmaf(md.y, d.z, products.z)};
    }
    __device__ void to(float* sums) const {
      const float all[] = {momentum.x, momentum.y, momentum.z, squares.x, squares.y,
                           squares.z,  products.x, products.y, products.z};
#pragma unroll
      for (int i = 0; i < 9; ++i) sums[i] = all[i];
    }
  };

  // Positions and velocities count from those of a mass, so that nothing cancels in a robot that is far from the origin
  // of the world, or fast.
  __device__ Vec3 first_position() const { return robot_.mass_at(0).vector(field_x); }
  __device__ Vec3 first_velocity() const { return robot_.mass_at(0).vector(field_v); }

  __device__ void measure_tiles(std::uint32_t share) const {
    const Vec3 origin = first_position(), moving = first_velocity();
    const bool uses_turn_rate = of_.uses_turn_rate;
    const std::uint32_t masses_of_robot = of_.masses;
    const auto* const at_rest = reinterpret_cast<const float4*>(of_.rest);
    MassSums masses;
    TurningSums turning;
    float shape[9] = {};
#pragma unroll
    for (std::uint32_t tile = 0; tile < tiles_per_share; ++tile) {
      const std::uint32_t slot = (share * tiles_per_share + tile) * lanes + robot_.lane;
      if (slot >= masses_of_robot) break;
      const float4 rest = __ldg(at_rest + slot);  // a RestingMass
      const float m = rest.w;
      const Vec3 x = robot_.mass_at(slot).vector(field_x), d = x - origin,
                 v = robot_.mass_at(slot).vector(field_v) - moving;
      masses.add(m, d, v, x.z);
      if (uses_turn_rate) turning.add(m, d, v);
      shape[0] = fmaf(rest.x, d.x, shape[0]), shape[1] = fmaf(rest.x, d.y, shape[1]);
      shape[2] = fmaf(rest.x, d.z, shape[2]), shape[3] = fmaf(rest.y, d.x, shape[3]);
      shape[4] = fmaf(rest.y, d.y, shape[4]), shape[5] = fmaf(rest.y, d.z, shape[5]);
      shape[6] = fmaf(rest.z, d.x, shape[6]), shape[7] = fmaf(rest.z, d.y, shape[7]);
      shape[8] = fmaf(rest.z, d.z, shape[8]);
    }
    float* const out = row_of_sums(share * (uses_turn_rate ? 2 : 1));
    float sums[sums_per_row];
    masses.to(sums);
#pragma unroll
    for (int i = 0; i < 9; ++i) sums[7 + i] = shape[i];
    write_sums(sums, out);
    if (!uses_turn_rate) return;
    turning.to(sums);
#pragma unroll
    for (std::uint32_t i = 9; i < sums_per_row; ++i) sums[i] = 0;
    write_sums(sums, out + sums_per_row);
  }

  __device__ void measure_masses(const SensingShare& share, float* out) const {
    const Vec3 origin = first_position(), moving = first_velocity();
    MassSums masses;
    for (std::uint32_t i = robot_.lane; i < share.count; i += lanes) {
      const std::uint32_t slot = of_.slots[share.first + i];
      const Vec3 x = robot_.mass_at(slot).vector(field_x);
      masses.add(of_.point_masses ? of_.point_masses[slot] : 1, x - origin,
                 robot_.mass_at(slot).vector(field_v) - moving, x.z);
    }
    float sums[sums_per_row] = {};
    masses.to(sums);
    write_sums(sums, out);
  }

  __device__ void write_sums(const float (&sums)[sums_per_row], float* out) const {
    const float sum = sums_of_warp(sums);
    if (robot_.lane % 2 == 0) out[robot_.lane / 2] = sum;
  }

  __device__ void measure_springs(const SensingShare& share, float* out) const {
    float strain = 0, rate = 0;
#pragma unroll 4
    for (std::uint32_t i = robot_.lane; i < share.count; i += lanes) {
      const SensedSpring spring = of_.springs[share.first + i];
      const Mass<Memory> a = robot_.mass_at(spring.a), b = robot_.mass_at(spring.b);
      const Vec3 d = b.vector(field_x) - a.vector(field_x), v = b.vector(field_v) - a.vector(field_v);
      const float length = sqrtf(dot(d, d));
      strain += length * spring.inverse_rest_length - 1;
      if (length > 0) rate += dot(d, v) / length * spring.inverse_rest_length;
    }
    for (unsigned distance = lanes / 2; distance > 0; distance /= 2) {
      strain += __shfl_xor_sync(0xffffffffu, strain, distance);
      rate += __shfl_xor_sync(0xffffffffu, rate, distance);
    }
    if (robot_.lane == 0) out[0] = strain, out[1] = rate;
  }

  // Of one place, the body's frame, or how it turns: each by a warp of its own.
  __device__ void conclude(std::uint32_t task) const {
    const bool of_place = task < of_.places;
    const PlaceSums sums(*this, of_place ? task : 0);
    if (of_place)
      conclude_place(task, sums);
    else if (task == of_.places)
      conclude_frame(sums);
    else
      conclude_turn_rate(sums);
  }
  __device__ std::uint32_t conclusions() const {
    return of_.places + (of_.uses_frame ? 1 : 0) + (of_.uses_turn_rate ? 1 : 0);
  }

  // Sums over the shares of a place, each in a lane: 0 to 15 those of masses, 16 to 24 what else tiles have of turning,
  // 25 and 26 those of springs. All lanes then ask for them and compute the same.
  class PlaceSums {
   public:
    __device__ PlaceSums(const Thought& thought, std::uint32_t number) {
      const SensedPlace& place = thought.place(number);
      const std::uint32_t lane = thought.robot_.lane;
      const std::uint32_t rows = number == 0 && thought.of_.uses_turn_rate ? 2 : 1;  // of a share of masses
      std::uint32_t row = place.first_row, count = place.mass_shares, column = lane, stride = rows;
      if (lane >= 16) ++row, column = lane - 16, count = rows == 2 ? count : 0;
      if (lane >= 25) row = place.first_row + rows * place.mass_shares, column = lane - 25, count = place.spring_shares;
      if (lane >= 25) stride = 1;
      if (lane >= 27) count = 0;
      const float* const sums = thought.row_of_sums(row) + column;
#pragma unroll 4
      for (std::uint32_t i = 0; i < count; ++i) sum_ += static_cast<double>(sums[i * stride * sums_per_row]);
    }
    __device__ double of(std::uint32_t column) const {
      return __shfl_sync(0xffffffffu, sum_, static_cast<int>(column));
    }
    __device__ Double3 three(std::uint32_t column) const {
      const double x = of(column), y = of(column + 1), z = of(column + 2);
      return {x, y, z};
    }

   private:
    double sum_ = 0;
  };

  __device__ const SensedPlace& place(std::uint32_t number) const { return body_part<SensedPlace>(0)[number]; }

  __device__ void conclude_place(std::uint32_t number, const PlaceSums& sums) const {
    const SensedPlace& place = this->place(number);
    const double share_of_mass = 1 / (number == 0 ? of_.mass : place.mass);
    const std::uint32_t masses = number == 0 ? of_.masses : place.masses;
    const double touching = sums.of(6), share_of_springs = place.springs > 0 ? 1.0 / place.springs : 0;
    PlaceMeasures measured;
    measured.center = Double3(first_position()) + share_of_mass * sums.three(0);
    measured.velocity = Double3(first_velocity()) + share_of_mass * sums.three(3);
    measured.touch = of_.world.ground ? touching / masses : 0;
    measured.strain = share_of_springs * sums.of(25);
    measured.strain_rate = share_of_springs * sums.of(26);
    if (robot_.lane == 0) place_measures(number) = measured;
  }

  __device__ void conclude_frame(const PlaceSums& sums) const {
    double s[9];
#pragma unroll
    for (std::uint32_t i = 0; i < 9; ++i) s[i] = sums.of(7 + i);
    const Rotation frame = rotation_of(s);
    if (robot_.lane == 0) body_measures().frame = frame;
  }

  __device__ void conclude_turn_rate(const PlaceSums& sums) const {
    const Double3 c = (1 / of_.mass) * sums.three(0), mc = sums.three(0),
                  momentum = sums.three(16) - cross(c, sums.three(3));
    const Double3 squares = sums.three(19), products = sums.three(22);
    const double xx = squares.x - mc.x * c.x, yy = squares.y - mc.y * c.y, zz = squares.z - mc.z * c.z;
    const Double3 turn_rate = angular_velocity(momentum, {yy + zz, xx + zz, xx + yy, -(products.x - mc.x * c.y),
                                                          -(products.y - mc.x * c.z), -(products.z - mc.y * c.z)});
    if (robot_.lane == 0) body_measures().turn_rate = turn_rate;
  }

  __device__ Clock clock() const {
    Clock clock = robot_.arguments.clock;
    clock.step += robot_.step;
    return clock;
  }
  __device__ void sense() const {
    float* const samples = of_.samples_of_senses;
    const float* const neurons = z_ + of_.senses;
    // Senses of one kind follow one another, so that a warp has few kinds.
    const std::uint32_t share = divide_up(of_.senses, robot_.warps), first = robot_.warp * share,
                        end = min(first + share, of_.senses);
#pragma unroll 1
    for (std::uint32_t i = first + robot_.lane; i < end; i += lanes) {
      const BrainPlan::Sense& sense = plan_part<BrainPlan::Sense>(0)[i];
      float value = 0;
      if (sense.kind == SensorKind::clock)
        value = clock_sense(sense, clock());
      else if (sense.kind == SensorKind::neuron || sense.kind == SensorKind::neighbors)
        value = sense.neuron == BrainPlan::none ? 0 : neurons[sense.neuron];
      else
        value = static_cast<float>(
            body_sense(sense, place_measures(sense.place), body_measures(), of_.world, of_.world.target));
      value *= sense.gain;
      if (sense.noise > 0) value = multiply_add(sense.noise, normal_number(of_.seed, of_.thought, i), value);
      z_[i] = sense.delay == 0 ? value : samples[(sense.delay - 1) * of_.senses + i];
#pragma unroll 1
      for (std::uint32_t sample = of_.samples - 1; sample > 0; --sample)
        samples[sample * of_.senses + i] = samples[(sample - 1) * of_.senses + i];
      samples[i] = value;
    }
  }

  // y <- k y + g act(W z + b). Eight lanes sum up a neuron; then a thread ends each, in as few warps as there can be,
  // since an activation takes more instructions than a short sum.
  __device__ void update(const BrainPlan::Layer& layer) const {
    float* const neurons = z_ + of_.senses;
    float* const sums = neurons + of_.neurons;
    const std::uint32_t groups = robot_.threads() / neuron_lanes, group = robot_.thread() / neuron_lanes,
                        member = robot_.thread() % neuron_lanes, count = layer.count;
    const Inputs inputs{plan_part<BrainPlan::Neuron>(of_.at.neurons) + layer.first,
                        plan_part<BrainPlan::Run>(of_.at.runs), of_.weights, z_, member};
#pragma unroll 1
    for (std::uint32_t i = group; i - group < count; i += groups) {
      const float sum = sum_of_lanes(i < count ? inputs.part_of_sum(i) : 0);
      if (i < count && member == 0) sums[i] = sum;
    }
    wait();
#pragma unroll 1
    for (std::uint32_t i = robot_.thread(); i < count; i += robot_.threads())
      neurons[layer.first + i] = updated(layer, i, sums[i]);
    wait();
    if (layer.learnings == 0) return;
#pragma unroll 1
    for (std::uint32_t i = robot_.thread(); i < layer.learnings; i += robot_.threads()) {
      const BrainPlan::Learning& learning = plan_part<BrainPlan::Learning>(of_.at.learnings)[layer.first_learning + i];
      const float y = neurons[learning.neuron], weight = of_.weights[learning.weight];
      of_.stored_weights[learning.weight] = of_.weights[learning.weight] =
          multiply_add(learning.rate * y, fnma(y, weight, z_[learning.source]), weight);
    }
    wait();
  }

  // The new activation of a neuron of a layer. All sums of the layer are known: only itself may be gated by it.
  __device__ float updated(const BrainPlan::Layer& layer, std::uint32_t i, float sum) const {
    const std::uint32_t number = layer.first + i;
    const BrainPlan::Neuron& neuron = plan_part<BrainPlan::Neuron>(of_.at.neurons)[number];
    const float clamped = part_of<float>(robot_.brain, of_.at.clamps)[number];
    const float* const neurons = z_ + of_.senses;
    const float y = neurons[number], act = activation_of(neuron.activation, sum);
    const float changed = layer.first_gate == BrainPlan::none
                              ? changed_activation(neuron, y, act)
                              : gated_activation(plan_part<BrainPlan::Gate>(of_.at.gates)[layer.first_gate + i],
                                                 neuron.alpha, neurons, y, act);
    return of_.activations[number] = std::isnan(clamped) ? changed : clamped;
  }

  // Lanes that add up a neuron's inputs together.
  static constexpr std::uint32_t neuron_lanes = 8;
  __device__ static float sum_of_lanes(float sum) {
    for (unsigned distance = neuron_lanes / 2; distance > 0; distance /= 2)
      sum += __shfl_xor_sync(0xffffffffu, sum, distance);
    return sum;
  }
  // What the neurons of a layer add up.
  struct Inputs {
    const BrainPlan::Neuron* neurons;
    const BrainPlan::Run* runs;
    const float *weights, *z;
    std::uint32_t member;  // of the lanes of a neuron

    // This lane's part: every eighth element of a run; if there are several, every eighth of the short ones. Lane 0 has
    // the bias.
    __device__ float part_of_sum(std::uint32_t i) const {
      const BrainPlan::Neuron& neuron = neurons[i];
      const std::uint32_t first = neuron.first_run, count = neuron.runs, bias = neuron.bias;
      float sum = member == 0 && bias != BrainPlan::none ? weights[bias] : 0;
#pragma unroll 1
      for (std::uint32_t r = 0; r < count; ++r) {
        const BrainPlan::Run run = runs[first + r];
        const float *w = weights + run.weight, *values = z + run.source;
        std::uint32_t left = run.count;
        if (left < neuron_lanes && count > 1) {
#pragma unroll 1
          for (left = r % neuron_lanes == member ? left : 0; left > 0; --left) sum = multiply_add(*w++, *values++, sum);
          continue;
        }
        w += member, values += member;
        left += neuron_lanes - 1 - member;  // eight times what this lane has, and less than eight more
#pragma unroll 1
        for (; left >= 4 * neuron_lanes; left -= 4 * neuron_lanes, w += 4 * neuron_lanes, values += 4 * neuron_lanes)
#pragma unroll
          for (std::uint32_t k = 0; k < 4 * neuron_lanes; k += neuron_lanes) sum = multiply_add(w[k], values[k], sum);
#pragma unroll 1
        for (; left >= neuron_lanes; left -= neuron_lanes, w += neuron_lanes, values += neuron_lanes)
          sum = multiply_add(*w, *values, sum);
      }
      return sum;
    }
  };

  __device__ void drive() const {
    const float* const neurons = z_ + of_.senses;
    const ActuationSources& sources = robot_.arguments.thoughts.sources;
#pragma unroll 1
    for (std::uint32_t i = robot_.thread(); i < of_.outputs; i += robot_.threads()) {
      const BrainPlan::Output output = plan_part<BrainPlan::Output>(of_.at.outputs)[i];
      const std::size_t at = of_.robot * sources.columns + output.actuator;
      const std::uint8_t driven = sources.driven[at];
      if (driven == held_drive) continue;
      sources.drive[at] = drive_of(neurons[output.neuron]);
      if (driven == 0) sources.driven[at] = 1;
    }
    if (robot_.thread() == 0) *of_.thoughts = ++of_.thought;
    MaterialTable<Body::solver> table(robot_.arguments, robot_.place, robot_.warp, robot_.warps, robot_.lane,
                                      robot_.material_table, robot_.moving);
    table.change_length_factors(of_.materials, [&](std::uint32_t id, float& factor) {
      const BrainMuscle muscle = part_of<BrainMuscle>(robot_.brain, of_.at.muscles)[id];
      if (muscle.neuron == BrainPlan::none) return false;
      Material& now = of_.materials_now[id];
      now.amplitude = muscle.amplitude;
      now.frequency = 0;
      now.phase = arcsine(drive_of(neurons[muscle.neuron]));
      now.half_wave = false;
      const MusclePhase phase = held_phase(now.phase);
      const MuscleSwing swing = MuscleSwing::of(now);
      of_.phases[id] = phase;
      of_.swings[id] = swing;
      factor = length_factor(swing.amplitude, sine_of_phase(phase.at_base), swing.highest_sine);
      return true;
    });
  }

  const Body& robot_;
  ThinkingRobot& of_;
  float* const z_;  // senses, then neurons
};

// The step of the launch before which a robot thinks first, by its place.
__device__ inline std::uint32_t first_thought(const StepArguments& arguments, std::uint32_t place) {
  const std::uint32_t thinker = arguments.thoughts.thinkers[place];
  if (thinker == Thoughts::none) return Thoughts::none;
  const std::int64_t steps = steps_to_thought(arguments.thoughts.robots[thinker].period, arguments.clock);
  return static_cast<std::uint32_t>(min(steps, std::int64_t{Thoughts::none}));
}

// All threads of a robot that thinks before this step of the launch call this. Returns the step of its next thought.
// Not inline, so that it takes no registers from the steps.
template <Solver solver, class Memory>
__device__ __noinline__ std::uint32_t think(const StepArguments& arguments, std::uint32_t at,
                                            typename Memory::Address masses, SpringParameters<solver>* material_table,
                                            std::uint32_t* moving, SplitBarrier barrier, std::uint32_t place,
                                            std::uint32_t warp, std::uint32_t step) {
  const ThinkingBody<solver, Memory> body{arguments,
                                          brain_memory<Memory>(arguments, at, place),
                                          masses,
                                          material_table,
                                          moving,
                                          barrier,
                                          place,
                                          warp,
                                          threadIdx.x % lanes,
                                          arguments.launch.warps_per_robot,
                                          step};
  Thought<ThinkingBody<solver, Memory>>(body).think();
  const std::int64_t next = body.step + part_of<ThinkingRobot>(body.brain, 0)->steps_per_thought;
  return static_cast<std::uint32_t>(min(next, std::int64_t{Thoughts::none}));
}

}  // namespace mercury::cuda
