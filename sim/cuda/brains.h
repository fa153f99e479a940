// SPDX-License-Identifier: Apache-2.0
// The brains of a batch on the device, where the step kernel lets them think (think.cuh).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "mercury/shared_array.h"
#include "sim/cuda/actuation.h"
#include "sim/cuda/brain_tables.h"
#include "sim/cuda/launch_configuration.h"
#include "sim/cuda/slot_order.h"
#include "sim/physics/brain_plan.h"

namespace mercury::cuda {

class DeviceBrains {
 public:
  // Of a robot with a brain.
  struct Thinker {
    std::size_t robot;  // its index in the batch
    const Robot* body;
    const BrainPlan* plan;
    const SlotOrder* order;
    std::uint32_t size_class, place;
    std::span<const DrivenMaterial> driven;  // in the order of their phases
    MusclePhase* phases;                     // of the robot's first material
    std::size_t columns;                     // of the shared arrays
  };

  bool empty() const { return thinkers_.size() == 0; }
  // What the launches of a class would keep of each robot's brain.
  BrainBytes bytes(std::uint32_t size_class) const { return empty() ? BrainBytes{} : bytes_[size_class]; }
  // Makes room in device memory for what launches keep elsewhere than on the chip.
  void reserve_workspace();
  // In the order of the batch. All states are zeros.
  // `class_sizes` = how many places each class has.
  void set(std::span<const Thinker> thinkers, std::span<const std::uint32_t> class_sizes, cudaStream_t stream);
  void clear() { *this = {}; }
  void write(const PackedBrains& brains, cudaStream_t stream);
  PackedBrains read(bool weights, cudaStream_t stream) const;
  // Backend::share_brains(). The arrays keep the memory.
  BrainArrays share(int device);
  bool is_shared() const { return shared_; }

  // For the launches of a class.
  Thoughts thoughts(std::uint32_t size_class, const Environment& environment, const Actuators& actuators) const;

 private:
  std::vector<DeviceArray<std::uint32_t>> thinkers_of_;  // [class][place]
  std::vector<BrainBytes> bytes_;                        // [class]
  DeviceArray<ThinkingRobot> thinkers_;
  DeviceArray<char> workspace_;
  std::uint32_t workspace_stride_ = 0;
  // What the robots point to.
  DeviceArray<std::byte> plans_, bodies_;
  DeviceArray<BrainMaterial> materials_;
  DeviceArray<std::uint16_t> slots_;
  DeviceArray<SensedSpring> springs_;
  DeviceArray<RestingMass> rest_;
  using SharedNumbers = std::shared_ptr<DeviceArray<float>>;
  SharedNumbers activations_, samples_, weights_;
  bool shared_ = false;
  DeviceArray<float> clamps_;
  DeviceArray<Vec3> targets_;
  DeviceArray<std::uint64_t> thoughts_, noise_seeds_;
};

}  // namespace mercury::cuda
