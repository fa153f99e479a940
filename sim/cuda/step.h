// SPDX-License-Identifier: Apache-2.0
// Launching the step kernels.
#pragma once

#include <cuda_runtime_api.h>

#include <type_traits>
#include <variant>

#include "sim/cuda/brain_tables.h"
#include "sim/cuda/launch_configuration.h"
#include "sim/cuda/layout.h"
#include "sim/cuda/telemetry.h"
#include "sim/physics/environments.h"
#include "sim/physics/integration.h"

namespace mercury::cuda {

struct StepArguments {
  BatchView batch;
  Clock clock;  // of the first step
  StepConstants constants;
  float stiffness_scale = 1;
  std::uint32_t steps = 0;
  bool lists_kept = false;  // the lists of contacts that the last launch left are still of these robots
  LaunchConfiguration launch;
  Reports reports;
  Thoughts thoughts;
};

// The environment of one robot, with the drift of step_constants().
struct OwnModel : GeneralModel {
  Vec3 drift;

  explicit OwnModel(const Configuration& configuration)
      : GeneralModel(configuration.environment), drift(step_constants(configuration).drift) {}
};
// Each robot has its own.
struct OwnModels {
  const OwnModel* models = nullptr;  // [robot], in device memory
};
// Robots in device memory wait for it most of the time, and few are too large by their valences alone, so both have
// one kernel for all environments, which is this one.
constexpr bool needs_own_models(const LaunchConfiguration& launch) {
  return !launch.on_chip || !launch.valence_on_chip;
}
using StepModel = std::variant<OceanModel, StillWaterOceanModel, OceanSimpleModel, LandModel, ResistiveModel,
                               GeneralModel, OwnModels>;

// Those without contacts that have a kernel of their own for robots in parts. The others use that of OwnModels.
template <class Model>
inline constexpr bool has_kernel_in_parts =
    std::is_same_v<Model, StillWaterOceanModel> || std::is_same_v<Model, OceanSimpleModel> ||
    std::is_same_v<Model, ResistiveModel>;

// The model whose kernel a launch uses. `own` = one per robot, or null where all live in the configuration's
// environment.
inline StepModel step_model_of(const Configuration& configuration, bool real_bodies, const LaunchConfiguration& launch,
                               const OwnModel* own = nullptr) {
  if (needs_own_models(launch) || own) return OwnModels{own};
  return std::visit([](const auto& model) -> StepModel { return model; }, solver_model_of(configuration, real_bodies));
}

// The same for robots in parts. `own` is one per robot; `differ` = whether their environments differ.
inline StepModel step_model_in_parts(const Configuration& configuration, bool real_bodies,
                                     const LaunchConfiguration& launch, const OwnModel* own, bool differ) {
  if (differ || launch.contact_buckets > 0) return OwnModels{own};
  return std::visit(
      [&]<class Model>(const Model& model) -> StepModel {
        if constexpr (has_kernel_in_parts<Model>)
          return model;
        else
          return OwnModels{own};
      },
      solver_model_of(configuration, real_bodies));
}

// The kernel for an environment, of which each kind of StepModel has a source in step_kernels/.
template <class EnvironmentModel>
using StepKernel = void (*)(const StepArguments, const EnvironmentModel);
template <class EnvironmentModel>
StepKernel<EnvironmentModel> step_kernel_for(Solver solver, const LaunchConfiguration& launch);

// Robots that the current device steps at the same time; 0 if it cannot have blocks in such clusters.
std::uint32_t robots_in_flight(Solver solver, const StepModel& model, const LaunchConfiguration& launch);

// Makes the kernel for this launch ready, once per device.
void prepare_steps(Solver solver, const StepModel& model, const LaunchConfiguration& launch);

// Asynchronous. prepare_steps() comes first. `early` = blocks may take their places on the device while the kernel
// before in the stream still runs; they then keep them from other streams.
void launch_steps(Solver solver, const StepModel& model, const StepArguments& arguments, bool early,
                  cudaStream_t stream);

}  // namespace mercury::cuda
