// SPDX-License-Identifier: Apache-2.0
// Fixtures that run a test on every backend, or on every backend with every pair of solver and environment.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "mercury/cuda_devices.h"
#include "mercury/simulation.h"

namespace mercury {

// A test of one backend. Without a CUDA device the CUDA case is skipped.
class BackendTest : public testing::TestWithParam<DeviceKind> {
 protected:
  void SetUp() override { skip_without(GetParam()); }
  Device device() const { return {.kind = GetParam()}; }

 public:
  static void skip_without(DeviceKind kind) {
    if (kind == DeviceKind::cuda && cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  }
  static std::string name(const testing::TestParamInfo<DeviceKind>& info) {
    return name_of(Device{.kind = info.param});
  }
};

// The presets, and combinations that only the general model describes.
inline constexpr std::array<std::string_view, 6> tested_environments{
    "ocean", "ocean-simple", "land", "ocean+ground+contacts", "ocean-simple+ground", "ocean+contacts"};

// A test of one backend, solver and environment.
using Pair = std::tuple<DeviceKind, Solver, std::string_view>;
class EveryPair : public testing::TestWithParam<Pair> {
 protected:
  void SetUp() override { BackendTest::skip_without(std::get<DeviceKind>(GetParam())); }
  Configuration configuration() const {
    return {.solver = std::get<Solver>(GetParam()),
            .environment = environment_named(std::get<std::string_view>(GetParam())),
            .device = {.kind = std::get<DeviceKind>(GetParam())}};
  }

 public:
  static std::string name(const testing::TestParamInfo<Pair>& info) {
    std::string text = name_of(Device{.kind = std::get<DeviceKind>(info.param)});
    text.append(1, '_').append(name_of(std::get<Solver>(info.param))).append(1, '_');
    for (const char letter : std::get<std::string_view>(info.param))
      text += letter == '-' || letter == '+' ? '_' : letter;
    return text;
  }
};

inline const auto every_device = testing::Values(DeviceKind::cpu, DeviceKind::cuda);
inline const auto every_pair = testing::Combine(every_device, testing::Values(Solver::force, Solver::xpbd),
                                                testing::ValuesIn(tested_environments));

// Empty space, without water or gravity. Only springs act.
inline OceanSimple empty_space() { return {.point_drag = 0}; }

}  // namespace mercury
