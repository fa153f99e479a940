// SPDX-License-Identifier: Apache-2.0
// Shell robots: thin hollow bodies of two layers of masses, like jellyfish, salps, rings and balls.
//
// A shell is a smooth surface around the z axis, sampled as a mesh of triangles. Each vertex carries two masses, one on
// either side of the surface, `thickness` apart:
//
//     outer  o------o------o      springs along the edges of the mesh in both layers (muscles or tissue),
//            |\    /|\    /|      a strut across the shell at each vertex,
//            | \  / | \  / |      and two diagonals across it at each edge
//            |  \/  |  \/  |
//            |  /\  |  /\  |
//     inner  o------o------o
//
// Muscles work in a wave that runs along the profile (from the top of a bell to its rim) and around the axis. Springs
// around the axis contract the shell; springs along the profile are antagonists in the two layers and bend it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

enum class ShellForm {
  bell,  // open at the bottom, like a jellyfish; the skin covers both sides, a sphere in topology
  tube,  // open at both ends; the skin covers both sides, a torus in topology
  ring,  // closed around a hole, hollow inside; the skin is the outer side, a torus
  pod    // closed, hollow inside; the skin is the outer side, a sphere
};

// Everything that a shell is built from. The ranges are those that validate() accepts.
struct ShellGenome {
  ShellForm form = ShellForm::bell;
  int segments = 26;         // masses of a layer around the widest place, 12 to 128; also sets their distance elsewhere
  int lobes = 8;             // around the axis, 3 to 16
  int waves_around = 0;      // of the muscles around the axis, -4 to 4
  double diameter = 1.4;     // at the widest place, without lobes [m], 0.2 to 20
  double thickness = 0.1;    // distance of the two layers [m], 0.01 to diameter / 4
  double height = 1.2;       // half the height by half the diameter, 0.2 to 3
  double opening = 0.5;      // of a bell's mouth, a tube's ends, a ring's hole: 0 narrow, 1 wide
  double squareness = 0;     // of the profile, -0.1 to 0.15
  double flare = 0;          // how far the rim turns outward, by the radius, 0 to 0.5
  double lobe_depth = 0;     // of the lobes, by the radius, 0 to 0.3
  double lappets = 0;        // how far lobes hang down at a rim, by the radius, 0 to 0.4
  double twist = 0;          // of the lobes from end to end of the profile [turns], -0.5 to 0.5
  double active = 0.85;      // share of the springs along the surface that are muscles, 0 to 1
  double contraction = 0.3;  // amplitude of the muscles around the axis, -0.4 to 0.4
  double bending = 0.1;      // amplitude of the muscles along the profile, -0.4 to 0.4
  double frequency = 3;      // of the muscles [rad/s], 0 to 20
  double waves_along = 1;    // of the muscles along the profile, -3 to 3
  std::string environment;   // where the robot belongs ("ocean"), kept in its origin; empty = not recorded
  friend bool operator==(const ShellGenome&, const ShellGenome&) = default;
};

// Throws ParameterError("lobes", ...) and so on for a value out of its range.
void validate(const ShellGenome& genome);

// The robot of a genome, bit for bit the same on every machine; its origin keeps the genome. It has materials of its
// own. Throws ParameterError as validate.
Robot grow(const ShellGenome& genome, const std::string& name = {});

// The genome in a robot's origin; none if the robot is not a shell. Throws InputError("/origin/lobes", ...) if the
// origin is of kind "shell" but cannot be used.
std::optional<ShellGenome> shell_genome_of(const Robot& robot);

// The genome with each number moved by a normal number times `strength` times 4 % of its range, and kept in its range.
// The form, the segments, the diameter and the thickness stay. With a strength above 0 at least one number changes: a
// draw without a change is repeated up to 30 times, then one number moves by a millionth of its range. Depends on the
// arguments alone.
ShellGenome mutate(const ShellGenome& genome, double strength, std::uint64_t seed);
// The same for the numbers of its muscles alone: waves, share, amplitudes and frequency; with a `tail` by numbers as of
// mutate_muscle_laws(), which are mirrored at the ends of the ranges.
ShellGenome mutate_muscles(const ShellGenome& genome, double strength, std::uint64_t seed, int tail = 0);

// A child of two shells: each number from either with probability 1/2, the form and the segments of the first. A shell
// that would be too thick is as thick as its diameter allows. Depends on the arguments alone.
ShellGenome crossover(const ShellGenome& a, const ShellGenome& b, std::uint64_t seed);

// How random shells are drawn.
struct ShellOptions {
  enum class Form { any, bell, tube, ring, pod } form = Form::any;
  float diameter = 1.4f;              // at the widest place [m]
  int segments = 26;                  // masses of a layer around the widest place
  float thickness = 0.1f;             // distance of the two layers [m]
  double opening = 0.5;               // 0 narrow, 1 wide; each robot's is drawn from 0.3 below to 0.2 above
  int lobes = 0;                      // around the axis; 0 = drawn for each robot
  double active = 0.85;               // share of the springs along the surface that are muscles
  std::string environment = "ocean";  // as in ShellGenome
};

// Throws ParameterError for options out of their range.
void validate(const ShellOptions& options);

// The genome of the index-th robot of a seed. It depends on the arguments alone, bit for bit on every machine. Throws
// ParameterError as validate.
ShellGenome random_shell_genome(const ShellOptions& options, std::uint64_t seed, std::uint64_t index = 0);

// The robot of that genome, "shell-SEED-INDEX".
Robot random_shell_robot(const ShellOptions& options, std::uint64_t seed, std::uint64_t index = 0);

}  // namespace mercury
