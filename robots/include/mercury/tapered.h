// SPDX-License-Identifier: Apache-2.0
// Tapered robots: bodies with a nose and a tail, which bend in a wave, such as eels, fish and worms.
//
// A body is a row of cross sections, two skins side by side that are joined: `layers` cells from one edge to the other.
//
//            ____-------_____                  o--o--o   x points ahead, to the nose
//      _--^^^                 ^^^^---__        |  |  |
//     <________________________________>>      o--o--o   one skin, seen from its side
//      tail                        nose        |  |  |
//
// Its cells are hexahedra, not cubes, so that real bodies (real_body.h) get springs and masses by the size of each.
// Muscles run along both skins, in `segments` from nose to tail. Those of one skin shorten where those of the other
// lengthen, and the wave runs backward.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "mercury/robot.h"

namespace mercury {

enum class TaperedBending {
  sideways,  // as fish do: the body is deep, and bends to the left and to the right
  up_down    // as inchworms do: it lies on its side
};

// Everything that a tapered robot is built from. The ranges are those that validate() accepts.
struct TaperedGenome {
  // Distances behind the nose at which depths and contractions are given, over the length.
  static constexpr std::array<double, 11> depth_places{0, 0.04, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.88, 0.94, 1};
  static constexpr std::array<double, 6> contraction_places{0, 0.2, 0.4, 0.6, 0.8, 1};

  TaperedBending bending = TaperedBending::sideways;
  int stations = 20;   // cells from nose to tail, 4 to 100
  int layers = 3;      // cells across a skin, 1 to 10
  int segments = 14;   // muscles along each skin, 2 to 30
  double volume = 30;  // of the body [liters], 0.1 to 1e5; with the depths it sets the length
  // From edge to edge, at depth_places, over the length; 0.01 to 0.5 each.
  std::array<double, 11> depths{0.05, 0.07, 0.09, 0.1, 0.1, 0.1, 0.09, 0.08, 0.07, 0.06, 0.04};
  double width = 0.55;   // distance of the skins in the middle, over the depth, 0.1 to 2
  double edge = 0.6;     // distance of the skins at both edges, over that in the middle, 0.1 to 1
  double frequency = 2;  // of the muscles [Hz], 0.1 to 5
  double waves = 1.7;    // of the muscles on the body, -3 to 3; below 0 they run from the tail to the nose
  std::array<double, 6> contractions{0.15, 0.2, 0.2,
                                     0.2,  0.2, 0.15};  // amplitudes at contraction_places, 0 to 0.4 each
  std::string environment;  // where the robot belongs ("water"), kept in its origin; empty = not recorded
  friend bool operator==(const TaperedGenome&, const TaperedGenome&) = default;
};

// Throws ParameterError("layers", ...) and so on for a value out of its range.
void validate(const TaperedGenome& genome);

// The robot of a genome, bit for bit the same on every machine; its origin keeps the genome. It has materials of its
// own: tissue, and two muscles per segment and skin, along the body and at an angle. Throws ParameterError as validate.
Robot grow(const TaperedGenome& genome, const std::string& name = {});

// The genome in a robot's origin; none if the robot is not a tapered one. Throws InputError("/origin/layers", ...) if
// the origin is of kind "tapered" but cannot be used.
std::optional<TaperedGenome> tapered_genome_of(const Robot& robot);

// The genome with about a third of its numbers moved by a normal number times `strength` times 2 % of their range.
// Cells, segments, volume and the direction of bending stay. With a strength above 0 at least one number changes.
// Depends on the arguments alone.
TaperedGenome mutate(const TaperedGenome& genome, double strength, std::uint64_t seed);

// A child of two: each number from either with probability 1/2; what mutations keep is the first's. Depends on the
// arguments alone.
TaperedGenome crossover(const TaperedGenome& a, const TaperedGenome& b, std::uint64_t seed);

// How random ones are drawn.
struct TaperedOptions {
  TaperedBending bending = TaperedBending::sideways;
  double volume = 30;  // [liters]
  int stations = 20, layers = 3;
  std::string environment = "water";  // as in TaperedGenome
};

// Throws ParameterError for options out of their range.
void validate(const TaperedOptions& options);

// The genome of the index-th robot of a seed. It depends on the arguments alone, bit for bit on every machine. Throws
// ParameterError as validate.
TaperedGenome random_tapered_genome(const TaperedOptions& options, std::uint64_t seed, std::uint64_t index = 0);

// The robot of that genome, "tapered-SEED-INDEX".
Robot random_tapered_robot(const TaperedOptions& options, std::uint64_t seed, std::uint64_t index = 0);

}  // namespace mercury
