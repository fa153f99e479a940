#include <algorithm>
#include <bit>

#include "sim/cuda/material_table.cuh"
#include "sim/cuda/memory.h"
#include "sim/cuda/step.cuh"

namespace mercury::cuda {
namespace {

extern __shared__ char shared_memory[];

// 48 registers let two blocks of 672 threads share a multiprocessor.
template <Solver solver, class Hooks, bool on_chip>
__global__ void __maxnreg__(48)
    step_kernel(const __grid_constant__ StepArguments arguments, const __grid_constant__ Hooks hooks) {
  using Stepper = RobotStepper<solver, Hooks>;
  const Shape& shape = arguments.shape;
  const BatchView& batch = arguments.batch;
  const std::uint32_t lane = threadIdx.x % lanes, block_warp = threadIdx.x / lanes;
  const std::uint32_t seat = block_warp / shape.warps_per_robot, warp = block_warp % shape.warps_per_robot;
  const std::uint32_t first_robot = blockIdx.x * shape.robots_per_block;
  const std::uint32_t robot = min(first_robot + seat, batch.robot_count - 1);
  const BlockLayout layout = block_layout(shape, batch.group_stride, Stepper::rows);
  const std::uint32_t working_bytes = batch.group_stride * Stepper::group_bytes;

  auto* const failure = reinterpret_cast<Failure*>(shared_memory + layout.tables) + seat;
  char* const workspace = batch.workspace + std::size_t{robot} * batch.workspace_stride;
  char* masses;
  if constexpr (on_chip)
    masses = shared_memory + layout.contacts + seat * working_bytes;
  else
    masses = workspace;
  char* const contacts = shape.contacts_on_chip
                             ? shared_memory + layout.failures + seat * contact_bytes(shape.contact_buckets, batch.group_stride)
                             : workspace + (on_chip ? 0 : working_bytes);

  const std::uint32_t table_size = shape.table_copies * max_materials;
  SpringLaw* const table = reinterpret_cast<SpringLaw*>(shared_memory) + (shape.shared_table ? 0 : seat * table_size);
  MaterialTable materials(arguments, shape.shared_table ? 0 : robot, shape.shared_table ? block_warp : warp,
                          shape.shared_table ? blockDim.x / lanes : shape.warps_per_robot, lane, table);
  materials.template fill<solver>(arguments, batch.robots[shape.shared_table ? first_robot : robot]);

  Stepper stepper(arguments, hooks, robot, warp, lane, masses, table + lane % shape.table_copies, failure, contacts);
  // The last block may have seats left; those and robots that exploded earlier only keep the barriers company.
  const bool seated = first_robot + seat < batch.robot_count && stepper.alive();
  if (warp == 0 && lane == 0) *failure = {seated ? never : 0, never};
  stepper.load_state();
  if constexpr (Hooks::has_contacts) stepper.fill_contacts();
  __syncthreads();

  for (std::uint32_t step = 0; step < arguments.steps; ++step) {
    stepper.add_environment(step);
    if constexpr (solver == Solver::xpbd) {
      if constexpr (Hooks::has_faces || Hooks::has_contacts) __syncthreads();
      stepper.predict(step);
      __syncthreads();
    }
    stepper.add_springs(step);
    __syncthreads();
    stepper.end(step);
    materials.update(arguments, step + 1);
    stepper.turn_contacts();
    __syncthreads();
  }
  if (seated) stepper.store_state();
}

template <Solver solver, class Hooks>
void launch(const Hooks& hooks, const StepArguments& arguments, cudaStream_t stream) {
  const auto kernel = arguments.shape.on_chip ? step_kernel<solver, Hooks, true> : step_kernel<solver, Hooks, false>;
  const Shape& shape = arguments.shape;
  const auto bytes = static_cast<int>(shape.shared_bytes);
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes), "reserving shared memory");
  const std::uint32_t blocks = (arguments.batch.robot_count + shape.robots_per_block - 1) / shape.robots_per_block;
  const std::uint32_t threads = shape.robots_per_block * shape.warps_per_robot * lanes;
  kernel<<<blocks, threads, shape.shared_bytes, stream>>>(arguments, hooks);
  check(cudaGetLastError(), "starting the step kernel");
}

struct Limits {
  std::uint32_t shared_per_block, shared_per_multiprocessor, reserved_per_block, threads_per_multiprocessor;
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
          attribute(cudaDevAttrReservedSharedMemoryPerBlock), attribute(cudaDevAttrMaxThreadsPerMultiProcessor)};
}

constexpr std::uint32_t most_warps = 21;   // 2 blocks of 672 threads with 48 registers each fill a multiprocessor
constexpr std::uint32_t least_warps = 2;   // the material table is shared out among them

// As many copies of the material table as leave `blocks` blocks on a multiprocessor.
bool fit(Shape& shape, std::uint32_t groups, std::uint32_t rows, const Limits& limits, std::uint32_t blocks) {
  for (const std::uint32_t copies : {16u, 8u, 4u, 2u, 1u}) {
    shape.table_copies = copies;
    shape.shared_bytes = block_layout(shape, groups, rows).total;
    if (shape.shared_bytes <= limits.shared_per_block &&
        blocks * (shape.shared_bytes + limits.reserved_per_block) <= limits.shared_per_multiprocessor)
      return true;
  }
  return false;
}

}  // namespace

std::uint32_t working_rows(Solver solver) { return solver == Solver::force ? working_rows_force : working_rows_xpbd; }

Shape choose_shape(Solver solver, const Environment& environment, std::uint32_t groups, std::uint32_t robots,
                   bool same_materials) {
  const Limits limits = device_limits();
  const std::uint32_t rows = working_rows(solver);
  Shape shape;
  shape.shared_table = same_materials;
  const std::uint32_t turns = (groups + most_warps - 1) / most_warps;
  shape.warps_per_robot = std::max(least_warps, (groups + turns - 1) / turns);
  const Land* land = std::get_if<Land>(&environment);
  if (land && land->self_collision && land->contact_stiffness > 0) shape.contact_buckets = std::bit_ceil(groups * lanes);
  shape.robots_per_block = std::clamp(most_warps / shape.warps_per_robot, 1u, std::max(robots, 1u));
  if (!same_materials && shape.robots_per_block > 1) shape.robots_per_block = std::min(shape.robots_per_block, 3u);
  for (; shape.robots_per_block > 1; --shape.robots_per_block)
    if (fit(shape, groups, rows, limits, 2)) return shape;
  if (fit(shape, groups, rows, limits, 2) || fit(shape, groups, rows, limits, 1)) return shape;
  shape.contacts_on_chip = false;
  if (fit(shape, groups, rows, limits, 1)) return shape;
  shape.on_chip = false;
  shape.warps_per_robot = 32;
  fit(shape, groups, rows, limits, 1);
  return shape;
}

void launch_steps(Solver solver, const AnyHooks& hooks, const StepArguments& arguments, cudaStream_t stream) {
  std::visit(
      [&](const auto& kind) {
        using Hooks = std::decay_t<decltype(kind)>;
        if (solver == Solver::force)
          launch<Solver::force, Hooks>(kind, arguments, stream);
        else
          launch<Solver::xpbd, Hooks>(kind, arguments, stream);
      },
      hooks);
}

}  // namespace mercury::cuda
