// SPDX-License-Identifier: Apache-2.0
// Materials: the stiffness of a spring and its movement as a muscle (paper, II.A and Table I).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mercury {

// At time t a spring of rest length L0 has the current rest length L(t) = L0 (1 + amplitude sin(frequency t + phase)).
// With half_wave only the negative half of the sine acts, L(t) = L0 (1 + amplitude min(0, sin(frequency t + phase))): a
// muscle of a positive amplitude shortens from its rest length and comes back, and never gets longer.
//
// A spring with a relaxation time tau also resists its rate of length (Kelvin-Voigt): it pulls with
// k (|d| - L + tau d|d|/dt).
struct Material {
  float stiffness = 0;  // k [N/m]
  float amplitude = 0;  // dL0, relative change of length [1], between -1 and 1
  float frequency = 0;  // omega [rad/s]
  float phase = 0;      // phi [rad]
  bool half_wave = false;
  float relaxation_time = 0;  // tau [s]
  friend constexpr bool operator==(const Material&, const Material&) = default;
};

using MaterialId = std::uint8_t;  // index in a table of materials

inline constexpr MaterialId air = 0;
inline constexpr int base_material_count = 22;  // ids 1..22: 20 muscles, tissue, bone
inline constexpr int muscle_count = 20;         // ids 1..20
inline constexpr MaterialId tissue = 21;
inline constexpr MaterialId bone = 22;
inline constexpr int default_material_count = 254;  // air, the base materials and their pairs
inline constexpr int max_materials = 256;           // air and up to 255 more

// The 254 default materials by id, including air. From id 23 on there are the pairs i < j of base materials in
// lexicographic order. A pair has the mean stiffness and amplitude of both, and the mean frequency and phase of those
// that move, and their mean relaxation time; it moves by half waves if all of those do. The span stays valid.
std::span<const Material> default_materials();

// The same table for other base materials: air, then `bases` as ids 1..22, then their pairs, with the ids and means of
// the default materials.
std::vector<Material> material_table(std::span<const Material, base_material_count> bases);

// "air", "muscle 1" .. "muscle 20", "tissue", "bone", "muscle 1 + bone", ...
std::string default_material_name(MaterialId id);

// The default material that combines base materials i and j (1..22 each, in any order). i == j gives i. Throws
// std::out_of_range for other ids.
MaterialId combine(MaterialId i, MaterialId j);

// The base materials of a default material: {i, j} with i <= j. i == j for a base material, {0, 0} for air. Throws
// std::out_of_range for an id above 253.
struct BasePair {
  MaterialId first, second;
};
BasePair base_materials_of(MaterialId id);

// Whether every value is finite, stiffness and relaxation time >= 0, and |amplitude| < 1.
bool is_valid(const Material& material);
// Throws InputError(where, ...) unless is_valid().
void validate(const Material& material, const std::string& where);

}  // namespace mercury
