// SPDX-License-Identifier: Apache-2.0
// What holds for robots whose muscles are fields.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include "mercury/generator.h"
#include "mercury/material.h"
#include "robots/bytes.h"
#include "robots/genes.h"
#include "robots/muscle_fields.h"

namespace mercury {

// How muscles move at a time, by the library's sine.

inline constexpr double turn = 2 * std::numbers::pi;

inline double wave_of(const FieldValue& value, double turns) {
  return value.cosine * std::sin(turn * turns) + value.sine * std::cos(turn * turns);
}

inline double wave_of(const Material& material, double time) {
  return static_cast<double>(material.amplitude) *
         std::sin(static_cast<double>(material.frequency) * time + static_cast<double>(material.phase));
}

// What evolution keeps of a robot, of a mutant and of their child, written and read.
inline void expect_same_genes_read_back(const Robot& robot, std::uint64_t seed) {
  const GenesKind& kind = *generator_of(robot)->genes;
  const auto genes = kind.of(robot);
  const auto mutant = genes->mutated(Genes::both, GeneMutation::of_strength(1), seed);
  for (const auto& one : {genes, mutant, genes->crossed(*mutant, Genes::both, seed)}) {
    ByteWriter writer;
    one->write(writer);
    const std::string bytes = std::move(writer).take();
    ByteReader reader(bytes);
    EXPECT_EQ(kind.read(reader)->grown("one", "ocean"), one->grown("one", "ocean"));
  }
  EXPECT_EQ(genes->grown(robot.name, "ocean"), robot);
  const Robot moved = genes->mutated(Genes::muscles, GeneMutation::of_strength(1), seed)->grown(robot.name, "ocean");
  EXPECT_EQ(moved.masses, robot.masses) << "the body stays";
  EXPECT_NE(moved.materials, robot.materials);
}

}  // namespace mercury
