// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "mercury/telemetry.h"

namespace mercury {

inline void expect_equal(const Telemetry& a, const Telemetry& b) {
  EXPECT_EQ(a.center_of_mass, b.center_of_mass);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.kinetic_energy, b.kinetic_energy);
  EXPECT_EQ(a.elastic_energy, b.elastic_energy);
  EXPECT_EQ(a.muscle_power, b.muscle_power);
  EXPECT_EQ(a.largest_strain, b.largest_strain);
  EXPECT_EQ(a.strained_share, b.strained_share);
  EXPECT_EQ(a.exploded, b.exploded);
  EXPECT_EQ(a.exploded_at, b.exploded_at);
  EXPECT_EQ(a.culprit_spring, b.culprit_spring);
}

}  // namespace mercury
