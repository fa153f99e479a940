// SPDX-License-Identifier: Apache-2.0
// Materials: how stiff a spring is and how it moves as a muscle (paper, II.A and Table I).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mercury {

// A spring of rest length L0 has at time t the length L(t) = L0 (1 + amplitude sin(frequency t + phase)).
struct Material {
  float stiffness = 0;  // k [N/m]
  float amplitude = 0;  // dL0, relative change of length [1], below 1
  float frequency = 0;  // omega [rad/s]
  float phase = 0;      // phi [rad]
  friend constexpr bool operator==(const Material&, const Material&) = default;
};

using MaterialId = std::uint8_t;

inline constexpr MaterialId air = 0;
inline constexpr int base_material_count = 22;  // ids 1..22: 20 muscles, tissue, bone
inline constexpr int muscle_count = 20;         // ids 1..20
inline constexpr MaterialId tissue = 21;
inline constexpr MaterialId bone = 22;
inline constexpr int default_material_count = 254;  // air, the base materials and their pairs
inline constexpr int max_materials = 256;           // air and up to 255 more

// The 254 defaults, air included, by id. Pairs i<j of base materials follow in lexicographic order from id 23:
// stiffness and amplitude are the means of both; frequency and phase the means over the partners that move.
std::span<const Material> default_materials();

// The table that other base materials give, `bases` being ids 1..22: air, then these, then their pairs, by the ids and
// means of the defaults.
std::vector<Material> material_table(std::span<const Material, base_material_count> bases);

// "air", "muscle 1" .. "muscle 20", "tissue", "bone", "muscle 1 + bone", ...
std::string default_material_name(MaterialId id);

// The default material that combines base materials i and j (1..22 each, in any order; i == j gives i).
// Throws std::out_of_range for other ids.
MaterialId combine(MaterialId i, MaterialId j);

// The base materials that a default material is made of: {i, j} with i <= j, equal for a base material, {0, 0} for air.
struct BasePair {
  MaterialId first, second;
};
BasePair base_materials_of(MaterialId id);

// Every value finite, stiffness >= 0 and |amplitude| < 1.
bool is_valid(const Material& material);
// Throws InputError("<where>", ...) unless is_valid.
void validate(const Material& material, const std::string& where);

}  // namespace mercury
