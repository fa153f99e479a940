// SPDX-License-Identifier: Apache-2.0
// The CUDA devices of this machine.
#include "mercury/cuda_devices.h"

#include <cstdlib>

#include "sim/cuda/device_limits.h"
#include "sim/cuda/device_parts.h"
#include "sim/cuda/memory.h"
#include "sim/cuda/rest_lengths.h"
#include "sim/cuda/step.h"
#include "sim/physics/measures.h"

namespace mercury {

using namespace cuda;

ChipFit chip_fit(const Robot& robot, const Configuration& configuration, int device) {
  if (device < 0 || device >= cuda_device_count())
    throw DeviceError("CUDA device " + std::to_string(device) + " is not there");
  check(cudaSetDevice(device), "choosing the device");
  BatchView batch{};
  batch.robot_count = many_robots;
  batch.tile_stride = tiles_for(robot.masses.size());
  batch.record_words = record_words_for(robot);
  const bool viscous = has_viscous_springs(measure(robot), materials_of(robot));
  const LaunchConfiguration launch = choose_launch_configuration(configuration, batch, true, viscous, many_robots);
  const bool real_bodies = viscous || has_own_points(robot);
  ChipFit fit{.most_bytes = device_limits().shared_per_block,
              .on_chip = launch.on_chip,
              .contacts_on_chip = launch.on_chip && launch.contacts_on_chip};
  if (!launch.on_chip) {
    const SlotOrder order = choose_slots(robot, pair_faces(robot));
    const DeviceParts::Source source{&robot, &order, {}};
    DeviceParts parts;
    if (const auto in_parts =
            parts.choose({&source, 1}, false, {.tiles = batch.tile_stride, .record_words = batch.record_words},
                         {.configuration = configuration,
                          .same_materials = true,
                          .viscous = viscous,
                          .table_chunks = launch.table_chunks,
                          .batch_size = many_robots})) {
      const StepModel model = step_model_in_parts(configuration, real_bodies, *in_parts, nullptr, false);
      fit.robots_at_once = robots_in_flight(configuration.solver, model, *in_parts);
      if (fit.robots_at_once > 0) {
        fit.on_chip = true;
        fit.blocks = in_parts->parts;
        return fit;
      }
    }
  }
  const StepModel model = step_model_of(configuration, real_bodies, launch);
  fit.robots_at_once = robots_in_flight(configuration.solver, model, launch);
  return fit;
}

int cuda_device_count() {
  int count = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess) {
    (void)cudaGetLastError();
    return 0;
  }
  return count;
}

// Measured with random voxel robots (docs/experiments.md).
void prepare_cuda_for(double robot_steps) {
  const char* const queues = robot_steps < 1e6 ? "1" : robot_steps < 1e8 ? "2" : robot_steps < 4e8 ? "8" : "12";
  setenv("CUDA_DEVICE_MAX_CONNECTIONS", queues, 0);
}

void require_cuda_device(int index) {
  const int count = cuda_device_count();
  if (count == 0) throw DeviceError("no CUDA device was found; use the device \"cpu\"");
  if (index >= count)
    throw DeviceError("CUDA device " + std::to_string(index) + " is not there, the last one is " +
                      std::to_string(count - 1));
}

std::string cuda_device_name(int index) {
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, index), "querying a device's name");
  return properties.name;
}

std::size_t free_cuda_memory(int index) {
  check(cudaSetDevice(index), "choosing the device");
  std::size_t free = 0, total = 0;
  check(cudaMemGetInfo(&free, &total), "asking for free memory");
  return free;
}

void synchronize_cuda_device(int index) {
  int callers = 0;
  check(cudaGetDevice(&callers), "querying the current device");
  check(cudaSetDevice(index), "choosing the device");
  const cudaError_t error = cudaDeviceSynchronize();
  check(cudaSetDevice(callers), "choosing the device");
  check(error, "waiting for the device");
}

void copy_cuda_memory(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpy(to, from, bytes, cudaMemcpyDefault), "copying memory");
}

bool built_with_cuda() { return true; }

}  // namespace mercury
