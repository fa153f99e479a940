// SPDX-License-Identifier: Apache-2.0
#include "mercury/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "tests/refusal.h"

namespace mercury {
namespace {

TEST(Materials, BaseMaterialsFollowTableOne) {
  const auto materials = default_materials();
  ASSERT_EQ(materials.size(), 254u);
  EXPECT_EQ(materials[air], (Material{0, 0, 0, 0}));
  EXPECT_EQ(materials[tissue], (Material{40, 0, 0, 0}));
  EXPECT_EQ(materials[bone], (Material{100, 0, 0, 0}));
  for (std::size_t id = 1; id <= 20; ++id) {
    EXPECT_EQ(materials[id].stiffness, 50);
    EXPECT_EQ(materials[id].amplitude, 0.14f);
  }
  EXPECT_EQ(materials[1].frequency, 1);
  EXPECT_EQ(materials[20].frequency, 5);
  EXPECT_FLOAT_EQ(materials[4].phase, 1.5f * std::numbers::pi_v<float>);
  EXPECT_EQ(materials[5].phase, 0);
}

TEST(Materials, PairsAreInLexicographicOrder) {
  int next = 23;
  for (int i = 1; i <= 22; ++i)
    for (int j = i + 1; j <= 22; ++j, ++next) {
      const auto a = static_cast<MaterialId>(i), b = static_cast<MaterialId>(j);
      EXPECT_EQ(combine(a, b), next);
      EXPECT_EQ(combine(b, a), next);
      const auto pair = base_materials_of(static_cast<MaterialId>(next));
      EXPECT_EQ(pair.first, a);
      EXPECT_EQ(pair.second, b);
    }
  EXPECT_EQ(next, 254);
  EXPECT_EQ(combine(7, 7), 7);
}

TEST(Materials, APassivePartnerLowersTheAmplitudeNotTheFrequency) {
  const auto materials = default_materials();
  const Material pair = materials[combine(20, bone)];
  EXPECT_FLOAT_EQ(pair.stiffness, 75);
  EXPECT_FLOAT_EQ(pair.amplitude, 0.07f);
  EXPECT_EQ(pair.frequency, materials[20].frequency);
  EXPECT_EQ(pair.phase, materials[20].phase);
  EXPECT_EQ(materials[combine(tissue, bone)], (Material{70, 0, 0, 0}));
}

TEST(Materials, APairMovesByHalfWavesIfAllThatMovesDoes) {
  const auto defaults = default_materials();
  std::vector<Material> bases(defaults.begin() + 1, defaults.begin() + 1 + base_material_count);
  bases[0].half_wave = bases[1].half_wave = bases[tissue - 1].half_wave = true;
  const auto table = material_table(std::span<const Material, base_material_count>(bases));
  EXPECT_TRUE(table[1].half_wave);
  EXPECT_TRUE(table[combine(1, 2)].half_wave);
  EXPECT_TRUE(table[combine(1, bone)].half_wave);
  EXPECT_FALSE(table[combine(1, 3)].half_wave) << "3 moves by whole waves";
  EXPECT_FALSE(table[combine(3, tissue)].half_wave);
  EXPECT_FALSE(table[combine(tissue, bone)].half_wave) << "nothing moves";
}

TEST(Materials, ATableOfTheDefaultBasesIsTheDefaultTable) {
  const auto materials = default_materials();
  const auto bases = materials.subspan<1, base_material_count>();
  EXPECT_TRUE(std::ranges::equal(material_table(bases), materials));
  std::vector<Material> others(bases.begin(), bases.end());
  others[4] = {80, 0.2f, 7, 1};
  const auto table = material_table(std::span<const Material, base_material_count>(others));
  EXPECT_EQ(table[5], (Material{80, 0.2f, 7, 1}));
  EXPECT_EQ(table[combine(5, tissue)], (Material{60, 0.1f, 7, 1}));
}

TEST(Materials, NamesAreDistinct) {
  std::set<std::string> names;
  for (int id = 0; id < default_material_count; ++id) names.insert(default_material_name(static_cast<MaterialId>(id)));
  EXPECT_EQ(names.size(), 254u);
  EXPECT_TRUE(names.contains("muscle 1 + bone"));
}

TEST(Materials, IdsThatAreNotBaseMaterialsCannotBeCombined) {
  EXPECT_THROW(combine(0, 1), std::out_of_range);
  EXPECT_THROW(combine(1, 23), std::out_of_range);
  EXPECT_THROW(base_materials_of(254), std::out_of_range);
}

TEST(Materials, ValidationNamesThePlaceAndTheRule) {
  const auto message = [](const Material& material) { return refusal([&] { validate(material, "/materials/3"); }); };
  EXPECT_EQ(message({50, 0.14f, 1, 0}), "");
  EXPECT_EQ(message({-1, 0, 0, 0}), "/materials/3: stiffness must be a finite number >= 0 N/m");
  EXPECT_EQ(message({50, 1, 0, 0}), "/materials/3: amplitude must lie between -1 and 1");
}

}  // namespace
}  // namespace mercury
