// Launching the step kernels.
#pragma once

#include <variant>

#include "sim/cuda/layout.h"
#include "sim/environments.h"
#include "sim/integration.h"

namespace mercury::cuda {

// What a block has and does.
struct Shape {
  std::uint32_t robots_per_block = 1;
  std::uint32_t warps_per_robot = 1;
  std::uint32_t table_copy_bits = 0;  // 2^this many copies of the material table, at most 16
  bool shared_table = false;        // all robots of the batch have the same materials
  bool on_chip = true;              // masses in shared memory, else in the workspace
  std::uint32_t contact_buckets = 0;  // a power of two, or 0 = no self-collision
  std::uint32_t record_words = 2;   // of the batch
  bool contacts_on_chip = true;       // else behind the working memory in the workspace
  std::size_t shared_bytes = 0;
};

struct StepArguments {
  BatchView batch;
  Clock clock;              // of the first step
  StepConstants constants;
  float stiffness_scale = 1;
  float contact_stiffness = 0;  // [N/m], times the stiffness scale
  std::uint32_t steps = 0;
  Shape shape;
};

using AnyHooks = std::variant<OceanHooks, OceanSimpleHooks, LandHooks>;

std::uint32_t working_rows(Solver solver);

// The shape that keeps most robots in flight on the present device. `groups` = of the largest robot.
Shape choose_shape(Solver solver, const Environment& environment, const BatchView& batch, bool same_laws);

// Robots that the present device steps at the same time.
std::uint32_t robots_in_flight(Solver solver, const AnyHooks& hooks, const Shape& shape);

// Springs a second if only the shared memory pipe counted: a row of 32 springs takes ten passes through it (four of the
// record, the position and the rest length, two of the material, three additions, and one more where XPBD reads splits).
double spring_limit(Solver solver);

// Asynchronous; errors through cudaGetLastError.
void launch_steps(Solver solver, const AnyHooks& hooks, const StepArguments& arguments, cudaStream_t stream);

}  // namespace mercury::cuda
