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
    std::size_t first_driven, driven;  // among the driven materials
  };

  bool empty() const { return thinkers_.size() == 0; }
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
  BrainTables tables_{};
  // What the tables point to.
  DeviceArray<ThinkingRobot> thinkers_;
  DeviceArray<BrainPlan::Sense> senses_;
  DeviceArray<BrainPlan::Neuron> neurons_;
  DeviceArray<BrainPlan::Run> runs_;
  DeviceArray<BrainPlan::Gate> gates_;
  DeviceArray<BrainPlan::Learning> learnings_;
  DeviceArray<BrainLayer> layers_;
  DeviceArray<BrainPlan::Output> outputs_;
  DeviceArray<SensedPlace> places_;
  DeviceArray<SensingShare> shares_;
  DeviceArray<std::uint16_t> slots_;
  DeviceArray<SensedSpring> springs_;
  DeviceArray<Vec3> rest_;
  using SharedNumbers = std::shared_ptr<DeviceArray<float>>;
  SharedNumbers activations_, samples_, weights_;
  bool shared_ = false;
  DeviceArray<float> clamps_, scratch_;
  DeviceArray<Vec3> targets_;
  DeviceArray<std::uint64_t> thoughts_, noise_seeds_;
  DeviceArray<float> sums_;
  DeviceArray<PlaceMeasures> measures_;
  DeviceArray<BodyMeasures> bodies_;
};

}  // namespace mercury::cuda
