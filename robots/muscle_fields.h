// SPDX-License-Identifier: Apache-2.0
// Muscles as fields: a network says by numbers how the muscle of each place moves and how stiff the place is, instead
// of choosing one of twenty materials. Painted voxel robots and network robots have them on request.
//
//   network at a place     value of the place                value of a spring        table of materials
//
//   phase                  stiffness                         mean of the places     mean of the values
//   amplitude       -->    amplitude cos(phase)       -->    that share it    -->   that are like it
//   stiffness              amplitude sin(phase)
//   frequency
//
// A table holds at most 255 materials, fewer than a body has springs. So values that are alike share one: the cloud of
// values is cut in two along its widest direction, then the part that spreads most, and so on, until there are as many
// parts as materials (after P. Heckbert, "Color image quantization for frame buffer display", 1982).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mercury/material.h"

namespace mercury {

inline constexpr int max_field_frequencies = 2;

// What all muscles of such a robot share.
struct FieldMuscles {
  int frequencies = 1;      // 1, or 2: half of the highest as well
  float frequency = 5;      // the highest [rad/s]
  float amplitude = 0.14f;  // the largest [1]
};

// What a network says of a place. Numbers beyond -1 and 1 count as these, except for the phase.
struct FieldOutputs {
  double phase = 0;      // [turns]
  double frequency = 0;  // the lowest below 0, else the highest
  double amplitude = 0;  // from 0 at -1 to the largest at 1
  double stiffness = 0;  // from half the stiffness of the place's kind at -1 to twice that at 1
};

// How a place or a spring moves, L = L0 (1 + cosine sin(wt) + sine cos(wt)).
struct FieldValue {
  double stiffness = 0;         // [N/m]
  double cosine = 0, sine = 0;  // amplitude times cosine and sine of the phase [1]
  int frequency = 0;            // which w: 0 is the lowest; 0 without an amplitude
  bool moves() const { return cosine != 0 || sine != 0; }
  friend bool operator==(const FieldValue&, const FieldValue&) = default;
};

// Of a place of this kind: a muscle (1 to 20), tissue or bone.
FieldValue field_value(MaterialId kind, const FieldOutputs& outputs, const FieldMuscles& muscles);

// Of a spring that these places share: the mean of their stiffnesses and of their waves. The mean of waves of two
// frequencies is no wave, so the places of the frequency that moves the spring more count alone, the others as at rest.
FieldValue mean_value(std::span<const FieldValue> values);

// At most `most` values in place of many; each of these has the mean of the values that it stands for.
struct FieldPalette {
  std::vector<FieldValue> values;
  std::vector<std::uint8_t> of;  // index of the value that stands for each
};
// `most` is 3 to 255.
FieldPalette palette_of(std::span<const FieldValue> values, std::size_t most);

// Air, then these values as materials, and their names: "muscle 1", "tissue 1", ...
struct FieldTable {
  std::vector<Material> materials;
  std::vector<std::string> names;
};
FieldTable table_of(std::span<const FieldValue> values, const FieldMuscles& muscles);

// Another highest frequency, by a normal number times `strength` times 0.5 rad/s, or amplitude, by one times `strength`
// times 0.02, or both; with a `tail` by numbers as of mutate_muscle_laws(). Something differs unless the strength is 0.
// Throws ParameterError unless the strength is finite and at least 0.
void move_muscles(float& frequency, float& amplitude, double strength, std::uint64_t seed, int tail = 0);

}  // namespace mercury
