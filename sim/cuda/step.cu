// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "sim/cuda/material_table.cuh"
#include "sim/cuda/memory.h"
#include "sim/cuda/report.cuh"
#include "sim/cuda/step.cuh"

namespace mercury::cuda {
namespace {

// With 72 registers a multiprocessor holds 28 warps.
template <Solver solver, class EnvironmentModel, class Memory, int record_words>
__global__ void __maxnreg__(72)
    step_kernel(const __grid_constant__ StepArguments arguments, const __grid_constant__ EnvironmentModel model) {
  using Stepper = RobotStepper<solver, EnvironmentModel, Memory, record_words>;
  const Shape& shape = arguments.shape;
  const BlockPlaces<Memory> places(arguments, Stepper::rows);
  const Seat<Memory>& seat = places.seat;
  MaterialTable materials(arguments, shape.shared_table ? places.first_robot : seat.robot,
                          shape.shared_table ? threadIdx.x / lanes : seat.warp,
                          shape.shared_table ? blockDim.x / lanes : shape.warps_per_robot, seat.lane, places.table);
  materials.template fill<solver>(arguments);
  Stepper stepper(arguments, model, seat, places.failure, places.contacts);
  // The last block may have seats left; those and robots that exploded earlier only keep the barriers company.
  const bool seated = places.has_robot && stepper.alive();
  if (seat.warp == 0 && seat.lane == 0) *places.failure = {seated ? never : 0, never};
  stepper.load_lengths(places.lengths);
  stepper.load_state();
  stepper.expect_environment();
  __syncthreads();
  int list_contacts = 1;

  for (std::uint32_t step = 0; step < arguments.steps; ++step) {
    if constexpr (EnvironmentModel::has_contacts)
      if (shape.contact_buckets > 0 && list_contacts) stepper.list_contacts();
    stepper.add_environment(step);
    if constexpr (solver == Solver::xpbd) {
      if constexpr (EnvironmentModel::has_faces || EnvironmentModel::has_contacts) __syncthreads();
      stepper.predict(step);
      __syncthreads();
    }
    stepper.add_springs(step);
    __syncthreads();
    stepper.end(step);
    stepper.expect_environment();
    materials.update(arguments, step + 1);
    if constexpr (EnvironmentModel::has_contacts)
      list_contacts = __syncthreads_or(stepper.contacts_stale());
    else
      __syncthreads();
  }
  if (seated) stepper.store_status();
  if (arguments.report)
    report<solver, Memory, record_words>(stepper, places.has_robot ? arguments.report + seat.robot : nullptr);
  if (seated) stepper.store_state();
}

template <Solver solver, class EnvironmentModel, int record_words>
auto kernel_for(const Shape& shape) {
  if constexpr (solver == Solver::xpbd)
    if (shape.on_chip && !shape.splits_on_chip)
      return step_kernel<solver, EnvironmentModel, OnChipWithoutSplits, record_words>;
  return shape.on_chip ? step_kernel<solver, EnvironmentModel, OnChip, record_words>
                       : step_kernel<solver, EnvironmentModel, OffChip, record_words>;
}

template <Solver solver, class EnvironmentModel>
auto kernel_for(const Shape& shape) {
  return shape.record_words == 1 ? kernel_for<solver, EnvironmentModel, 1>(shape)
                                 : kernel_for<solver, EnvironmentModel, 2>(shape);
}

template <class Kernel>
void prepare(Kernel kernel, const Shape& shape) {
  const auto bytes = static_cast<int>(shape.shared_bytes);
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes), "reserving shared memory");
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout, cudaSharedmemCarveoutMaxShared),
        "preferring shared memory");
}

template <Solver solver, class EnvironmentModel>
void launch(const EnvironmentModel& model, const StepArguments& arguments, cudaStream_t stream) {
  const auto kernel = kernel_for<solver, EnvironmentModel>(arguments.shape);
  const Shape& shape = arguments.shape;
  prepare(kernel, shape);
  const std::uint32_t blocks = (arguments.batch.robot_count + shape.robots_per_block - 1) / shape.robots_per_block;
  const std::uint32_t threads = shape.robots_per_block * shape.warps_per_robot * lanes;
  kernel<<<blocks, threads, shape.shared_bytes, stream>>>(arguments, model);
  check(cudaGetLastError(), "starting the step kernel");
}

struct Limits {
  std::uint32_t shared_per_block, shared_per_multiprocessor, reserved_per_block, multiprocessors;
};

Limits device_limits() {
  int device = 0;
  check(cudaGetDevice(&device), "asking for the device");
  const auto attribute = [&](cudaDeviceAttr which) {
    int value = 0;
    check(cudaDeviceGetAttribute(&value, which, device), "asking for the device's limits");
    return static_cast<std::uint32_t>(value);
  };
  return {attribute(cudaDevAttrMaxSharedMemoryPerBlockOptin), attribute(cudaDevAttrMaxSharedMemoryPerMultiprocessor),
          attribute(cudaDevAttrReservedSharedMemoryPerBlock), attribute(cudaDevAttrMultiProcessorCount)};
}

// What the kernel's registers allow: so many warps on a multiprocessor, at best in two blocks, so that one computes
// while the other waits at a barrier.
constexpr std::uint32_t resident_warps = 28;
// Groups that a warp takes in turn: enough to hide a barrier's cost, few enough to share the work evenly.
constexpr std::uint32_t fewest_turns = 3;

// The fewest warps, at most `most`, with which a robot's groups take as many turns as with `most`.
std::uint32_t even_warps(std::uint32_t groups, std::uint32_t most) {
  const std::uint32_t turns = std::max((groups + most - 1) / most, std::min(fewest_turns, groups));
  return (groups + turns - 1) / turns;
}

// As many copies of the material table as leave room for `blocks` blocks on a multiprocessor. False if not one does.
bool fit(Shape& shape, std::uint32_t groups, std::uint32_t rows, const Limits& limits, std::uint32_t blocks) {
  for (const std::uint32_t bits : {4u, 3u, 2u, 1u, 0u}) {
    shape.table_copy_bits = bits;
    shape.shared_bytes = block_layout(shape, groups, rows).total;
    if (shape.shared_bytes <= limits.shared_per_block &&
        blocks * (shape.shared_bytes + limits.reserved_per_block) <= limits.shared_per_multiprocessor)
      return true;
  }
  return false;
}

// Small robots: several a block, while the multiprocessor's warps are filled by at least two blocks.
bool fit_several(Shape& shape, std::uint32_t groups, std::uint32_t rows, const Limits& limits, std::uint32_t robots) {
  shape.warps_per_robot = even_warps(groups, resident_warps / 2);
  for (std::uint32_t seats = std::min(resident_warps / 2 / shape.warps_per_robot, robots); seats > 0; --seats) {
    shape.robots_per_block = seats;
    if (fit(shape, groups, rows, limits, resident_warps / (seats * shape.warps_per_robot))) return true;
  }
  return false;
}

// Large robots: one a block and multiprocessor.
bool fit_one(Shape& shape, std::uint32_t groups, std::uint32_t rows, const Limits& limits) {
  shape.robots_per_block = 1;
  const std::uint32_t turns = (groups + resident_warps - 1) / resident_warps;
  shape.warps_per_robot = (groups + turns - 1) / turns;
  return fit(shape, groups, rows, limits, 1);
}

}  // namespace

std::size_t most_shared_bytes() { return device_limits().shared_per_block; }

Shape choose_shape(Solver solver, const Environment& environment, const BatchView& batch, bool same_materials) {
  const Limits limits = device_limits();
  const std::uint32_t groups = batch.group_stride, robots = batch.robot_count;
  Shape shape;
  shape.shared_table = same_materials;
  shape.record_words = batch.record_words;
  shape.contact_buckets = contact_buckets(environment, groups);
  // Fewer robots than multiprocessors: each gets one to itself.
  const std::uint32_t all_rows = working_rows(solver, true);
  if (robots > limits.multiprocessors && fit_several(shape, groups, all_rows, limits, robots)) return shape;
  for (const bool contacts_on_chip : {true, false})
    for (const bool splits_on_chip : {true, false}) {
      shape.contacts_on_chip = contacts_on_chip;
      shape.splits_on_chip = splits_on_chip;
      if (fit_one(shape, groups, working_rows(solver, splits_on_chip), limits)) return shape;
    }
  shape.on_chip = false;
  shape.splits_on_chip = true;
  fit_one(shape, groups, all_rows, limits);
  return shape;
}

std::uint32_t robots_in_flight(Solver solver, const AnyEnvironmentModel& model, const Shape& shape) {
  return std::visit(
      [&](const auto& kind) {
        using EnvironmentModel = std::decay_t<decltype(kind)>;
        const auto kernel = solver == Solver::force ? kernel_for<Solver::force, EnvironmentModel>(shape)
                                                    : kernel_for<Solver::xpbd, EnvironmentModel>(shape);
        prepare(kernel, shape);
        int blocks = 0;
        const auto threads = static_cast<int>(shape.robots_per_block * shape.warps_per_robot * lanes);
        check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, threads, shape.shared_bytes),
              "asking for occupancy");
        return static_cast<std::uint32_t>(blocks) * shape.robots_per_block * device_limits().multiprocessors;
      },
      model);
}

double spring_limit(Solver solver) {
  int device = 0, kilohertz = 0;
  check(cudaGetDevice(&device), "asking for the device");
  check(cudaDeviceGetAttribute(&kilohertz, cudaDevAttrClockRate, device), "asking for the clock rate");
  const double passes = solver == Solver::force ? 10 : 11;
  return 1e3 * kilohertz * device_limits().multiprocessors * lanes / passes;
}

void launch_steps(Solver solver, const AnyEnvironmentModel& model, const StepArguments& arguments,
                  cudaStream_t stream) {
  std::visit(
      [&](const auto& kind) {
        using EnvironmentModel = std::decay_t<decltype(kind)>;
        if (solver == Solver::force)
          launch<Solver::force, EnvironmentModel>(kind, arguments, stream);
        else
          launch<Solver::xpbd, EnvironmentModel>(kind, arguments, stream);
      },
      model);
}

}  // namespace mercury::cuda
