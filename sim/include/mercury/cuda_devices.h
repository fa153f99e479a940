// SPDX-License-Identifier: Apache-2.0
// The CUDA devices of this machine, and how well a robot fits on them.
#pragma once

#include <cstddef>
#include <string>

#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

// False in a build without nvcc. It then finds no devices.
bool built_with_cuda();
// Usable CUDA devices; 0 without a driver or in a build without CUDA.
int cuda_device_count();
// Says how much there is to do, in steps of one robot. To be called before all else that uses CUDA in this process, by
// a program: CUDA makes 8 queues for the work of its streams, each in 15 to 30 ms, and what is in a queue waits for
// what is before it. So fewer are better for a short trial, and more for an evolution of some seconds. Sets the
// environment variable CUDA_DEVICE_MAX_CONNECTIONS, unless it is set.
void prepare_cuda_for(double robot_steps);
// Throws DeviceError if there is no device of that index, or none at all for Device::all_devices. It takes half of the
// time in which a device starts.
void require_cuda_device(int index);
// For example "NVIDIA H100 80GB HBM3"; empty in a build without CUDA. Throws DeviceError if the device does not exist.
std::string cuda_device_name(int index);
// Memory of a device that no program uses [bytes]. Throws DeviceError if the device does not exist.
std::size_t free_cuda_memory(int index);
// Waits for all work of all streams of a device. Throws DeviceError if work has failed.
void synchronize_cuda_device(int index);
// Copies between any two places in the memory of CUDA devices and of the host. Throws DeviceError.
void copy_cuda_memory(void* to, const void* from, std::size_t bytes);

// The shared memory that a thread block needs to step this robot on the chip, without any that only serves speed
// [bytes]: 36 per mass (paper, Table II), the material table, the rest lengths, and on land the grid that finds
// contacts. A robot stays on the chip, contacts included, on devices whose blocks may have this much. Works in every
// build.
std::size_t chip_bytes(const Robot& robot, const Configuration& configuration);

// How a large batch of one robot is laid out on a device.
struct ChipFit {
  std::size_t most_bytes = 0;      // shared memory that a block of this device may have [bytes]
  bool on_chip = false;            // the masses stay in shared memory; otherwise in device memory, which is slower
  std::uint32_t blocks = 1;        // that step a robot together, each a part of it in its shared memory
  bool contacts_on_chip = false;   // the grid that finds contacts stays in shared memory, too
  std::size_t robots_at_once = 0;  // robots of this kind that the device steps at the same time
};

// Throws DeviceError if there is no CUDA device of that index.
ChipFit chip_fit(const Robot& robot, const Configuration& configuration, int device);

}  // namespace mercury
