// SPDX-License-Identifier: Apache-2.0
// All kernels of the CPU with all pairs of solver and environment, as parameters of tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/cpu/backend.h"

namespace mercury::test {

struct KernelCase {
  cpu::Kernel kernel;
  Solver solver;
  std::string_view environment;
  Vec3 flow{};  // of the water
  float drag_tangential = 0;

  Configuration configuration() const {
    Configuration configuration{
        .solver = solver, .environment = environment_named(environment), .device = {.threads = 1}};
    if (auto* const water = std::get_if<FaceDrag>(&configuration.environment.water)) {
      water->flow = flow;
      water->drag_tangential = drag_tangential;
    }
    if (auto* const water = std::get_if<PointDrag>(&configuration.environment.water)) water->flow = flow;
    if (auto* const water = std::get_if<ResistiveDrag>(&configuration.environment.water)) {
      water->flow = flow;
      water->one_sided = true;  // the general model has all else of resistive water, too
    }
    return configuration;
  }
};

inline std::vector<KernelCase> every_kernel_case() {
  std::vector<KernelCase> cases;
  for (const cpu::Kernel& kernel : cpu::kernels())
    for (const Solver solver : {Solver::force, Solver::xpbd})
      for (const std::string_view environment : {"ocean", "ocean-simple", "land", "ocean+ground+contacts", "resistive"})
        cases.push_back({kernel, solver, environment});
  return cases;
}

inline std::string name_of_kernel_case(const testing::TestParamInfo<KernelCase>& info) {
  std::string name;
  for (const std::string_view part : {info.param.kernel.name, name_of(info.param.solver), info.param.environment}) {
    if (!name.empty()) name += '_';
    for (const char c : part)
      if (c != '-' && c != '+') name += c;
  }
  return name;
}

}  // namespace mercury::test
