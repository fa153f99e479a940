// SPDX-License-Identifier: Apache-2.0
#include "mercury/material.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "mercury/error.h"

namespace mercury {
namespace {

constexpr Material base_material(int id) {
  if (id <= 0) return {};
  if (id <= muscle_count) {
    const int m = id - 1;
    return {50, 0.14f, static_cast<float>(m / 4 + 1), static_cast<float>(m % 4) * std::numbers::pi_v<float> / 2};
  }
  return id == tissue ? Material{40, 0, 0, 0} : Material{100, 0, 0, 0};
}

constexpr Material mean(const Material& a, const Material& b) {
  const float moving = (a.amplitude != 0 ? 1.f : 0.f) + (b.amplitude != 0 ? 1.f : 0.f);
  const auto over_moving = [&](float of_a, float of_b) {
    const float sum = (a.amplitude != 0 ? of_a : 0) + (b.amplitude != 0 ? of_b : 0);
    return moving > 0 ? sum / moving : 0;
  };
  const auto whole_wave = [](const Material& one) { return one.amplitude != 0 && !one.half_wave; };
  return {(a.stiffness + b.stiffness) / 2,
          (a.amplitude + b.amplitude) / 2,
          over_moving(a.frequency, b.frequency),
          over_moving(a.phase, b.phase),
          moving > 0 && !whole_wave(a) && !whole_wave(b),
          (a.relaxation_time + b.relaxation_time) / 2};
}

struct Defaults {
  std::array<Material, default_material_count> materials{};
  std::array<BasePair, default_material_count> pairs{};
};

constexpr Defaults make_defaults() {
  Defaults defaults;
  for (int i = 0; i <= base_material_count; ++i) {
    const auto id = static_cast<MaterialId>(i);
    defaults.materials[id] = base_material(i);
    defaults.pairs[id] = {id, id};
  }
  std::size_t next = base_material_count + 1;
  for (int i = 1; i <= base_material_count; ++i)
    for (int j = i + 1; j <= base_material_count; ++j, ++next) {
      defaults.materials[next] = mean(base_material(i), base_material(j));
      defaults.pairs[next] = {static_cast<MaterialId>(i), static_cast<MaterialId>(j)};
    }
  return defaults;
}

constexpr Defaults defaults = make_defaults();

std::string base_name(int id) {
  if (id == air) return "air";
  if (id == tissue) return "tissue";
  if (id == bone) return "bone";
  return "muscle " + std::to_string(id);
}

void require_base(int id) {
  if (id < 1 || id > base_material_count)
    throw std::out_of_range("material " + std::to_string(id) + " is not a base material (1 to 22)");
}

}  // namespace

std::vector<Material> material_table(std::span<const Material, base_material_count> bases) {
  std::vector<Material> table(default_material_count);
  for (std::size_t id = 1; id < table.size(); ++id) {
    const auto [i, j] = defaults.pairs[id];
    table[id] = i == j ? bases[i - 1u] : mean(bases[i - 1u], bases[j - 1u]);
  }
  return table;
}

std::span<const Material> default_materials() { return defaults.materials; }

std::string default_material_name(MaterialId id) {
  const auto [i, j] = base_materials_of(id);
  return i == j ? base_name(i) : base_name(i) + " + " + base_name(j);
}

MaterialId combine(MaterialId i, MaterialId j) {
  require_base(i);
  require_base(j);
  if (i == j) return i;
  if (i > j) std::swap(i, j);
  // Pairs are ordered (1,2) .. (1,22), (2,3) ..: sum over r < i of (22 - r) of them come before those of i.
  const int before = (i - 1) * base_material_count - i * (i - 1) / 2;
  return static_cast<MaterialId>(base_material_count + 1 + before + (j - i - 1));
}

BasePair base_materials_of(MaterialId id) {
  if (id >= default_material_count)
    throw std::out_of_range("material " + std::to_string(id) + " is not one of the 254 defaults");
  return defaults.pairs[id];
}

bool is_valid(const Material& material) {
  return std::isfinite(material.stiffness) && material.stiffness >= 0 && std::abs(material.amplitude) < 1 &&
         std::isfinite(material.frequency) && std::isfinite(material.phase) &&
         std::isfinite(material.relaxation_time) && material.relaxation_time >= 0;
}

void validate(const Material& material, const std::string& where) {
  const auto require = [&](bool holds, const char* what) {
    if (!holds) throw InputError(where, what);
  };
  require(std::isfinite(material.stiffness) && material.stiffness >= 0, "stiffness must be a finite number >= 0 N/m");
  require(std::abs(material.amplitude) < 1, "amplitude must lie between -1 and 1");
  require(std::isfinite(material.frequency), "frequency must be a finite number of rad/s");
  require(std::isfinite(material.phase), "phase must be a finite number of rad");
  require(std::isfinite(material.relaxation_time) && material.relaxation_time >= 0,
          "relaxation_time must be a finite number >= 0 s");
}

}  // namespace mercury
