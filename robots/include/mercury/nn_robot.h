// SPDX-License-Identifier: Apache-2.0
// Robots grown by a neural network (paper, III.B): a cloud of random points goes through the network, which gives each
// a place and a material; the body is the alpha shape of the places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mercury/network.h"
#include "mercury/robot.h"

namespace mercury {

inline constexpr std::size_t min_cloud_points = 64;

// All that a robot is grown from. Evolution works on this.
struct NnGenome {
  Network network;
  std::uint64_t cloud_seed = 0;  // of the standard normal points that go in
  std::size_t points = 512;      // how many, 64 .. 65,535
  bool mirrored = false;         // points come in pairs, (x, y, z...) and (x, -y, z...)
  float alpha = 0;          // radius of the alpha shape [m]; 0 = the smallest that gives one body holding all points
  std::string environment;  // where it is meant to live, for environment_of(); empty = not said
  friend bool operator==(const NnGenome&, const NnGenome&) = default;
};

// The robot of a genome, bit for bit the same on every machine; its origin keeps the genome.
//   Places are centred and scaled into the unit sphere [m]. Masses are the places that the body holds, ordered along a
// Z-curve so that neighbours in space are near in memory. Springs are the edges of the body's tetrahedra, those shorter
// than 0.001 m left out; their material combines the materials of their two masses. Faces are the skin of the body.
//   Throws InputError if the genome is not valid (see `validate`), or if its places are not finite, all the same, in
//   one
// plane, or hold no body of the given alpha.
Robot grow(const NnGenome& genome, const std::string& name = {});

// Throws InputError unless the network is valid and all its numbers are finite, there are 64 to 65,535 points, and
// alpha is finite and >= 0.
void validate(const NnGenome& genome);

// The genome that a robot's origin keeps; none if it was not grown by a network. Throws InputError, its place a JSON
// pointer ("/origin/weights/1"), if the origin says so but cannot be used.
std::optional<NnGenome> nn_genome_of(const Robot& robot);

// The genome as the JSON text of Robot::origin. Weights are written as the shortest decimals that give the same floats
// back.
std::string to_origin(const NnGenome& genome);

// A genome whose network changes (see mutate and crossover of networks). Of two parents the child has the cloud, the
// symmetry and the alpha of the first, so that it differs from it by what it got from the second alone.
NnGenome mutate(const NnGenome& genome, double rate, double size, std::uint64_t seed);
NnGenome crossover(const NnGenome& a, const NnGenome& b, std::uint64_t seed);

// How random robots are drawn.
struct NnOptions {
  std::vector<int> hidden = {64, 64};  // sizes of the hidden layers, 6 to 4,096
  std::size_t points = 512;
  float alpha = 0;          // [m]; 0 = as in NnGenome
  double mirrored = 0.5;    // share of robots with mirror symmetry
  std::string environment;  // as in NnGenome
};

// Throws InputError("--hidden: 3 is not accepted; ...") and the like unless there are at most 15 hidden layers of 6 to
// 4,096 neurons, 64 to 65,535 points, a finite alpha >= 0 and a share from 0 to 1.
void validate(const NnOptions& options);

// The genome of the index-th robot of a seed. It depends on options, seed and index alone, bit for bit on every
// machine. Its initial weights are drawn so that bodies differ clearly (nn_initial.cpp).
NnGenome random_nn_genome(const NnOptions& options, std::uint64_t seed, std::uint64_t index = 0);

// The robot of that genome, "nn-SEED-INDEX".
Robot random_nn_robot(const NnOptions& options, std::uint64_t seed, std::uint64_t index = 0);

struct FailedRobot {
  std::uint64_t index;
  std::string reason;
};

// Robots first .. first + count - 1 of a seed, grown on all cores. One whose cloud is degenerate is left out and told
// in `failed`; without `failed` the first such error is thrown.
std::vector<Robot> random_nn_robots(const NnOptions& options, std::uint64_t seed, std::size_t count,
                                    std::uint64_t first = 0, std::vector<FailedRobot>* failed = nullptr);

}  // namespace mercury
