// SPDX-License-Identifier: Apache-2.0
// Robots grown by a neural network (paper, III.B). A cloud of random points goes through the network, which gives each
// point a place and a material. The body is the alpha shape of the places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mercury/generator.h"
#include "mercury/network.h"
#include "mercury/robot.h"

namespace mercury {

inline constexpr std::size_t min_cloud_points = 64;

// Everything that a robot is grown from. Evolution changes genomes, not bodies.
struct NnGenome {
  Network network;
  std::uint64_t cloud_seed = 0;  // of the standard normal points that enter the network
  std::size_t points = 512;      // of the cloud, 64 .. 65,535
  bool mirrored = false;         // points come in pairs, (x, y, z...) and (x, -y, z...)
  float alpha = 0;    // radius of the alpha shape [m]; 0 = the smallest that gives one body holding all points
  float spacing = 0;  // of the points: by this share of their mean spacing they stay apart, 0 to 1
  // Of its muscles, if the network has fields: how many, the highest [rad/s], and the largest amplitude [1].
  int frequencies = 1;
  float frequency = 5;
  float amplitude = 0.14f;
  std::string environment;  // where the robot belongs ("ocean"), kept in its origin; empty = not recorded
  friend bool operator==(const NnGenome&, const NnGenome&) = default;
};

// The robot of a genome, bit for bit the same on every machine; its origin keeps the genome.
// Places are centered and scaled into the unit sphere [m]. With a spacing, places nearer to each other than that are
// thinned and the others pushed apart a little (robots/nn/cloud_spacing.h says how and why). Masses are the places that
// the body holds, ordered along a Z-curve so that neighbors in space are near in memory. Springs are the edges of the
// body's tetrahedra, except those shorter than 0.001 m; their material combines the materials of their two masses.
// Faces are the skin of the body. With fields the scores choose between muscle, tissue and bone, and four outputs,
// each times 1/4, give each mass a phase [turns], one of the frequencies (the higher one above 0), an amplitude from 0
// at -1.5 to the largest at 0.5, and a stiffness from half that of its kind at -1 to twice that at 1; a spring moves by
// the mean of its masses' waves, and springs that are alike share one of 255 materials (robots/muscle_fields.h). Throws
// InputError if the genome is not valid, or if its places are not finite, all the same, in one plane, or hold no body
// of the given alpha.
Robot grow(const NnGenome& genome, const std::string& name = {});
// The same robot, whose origin names its kind alone: writing a network as text takes longer than growing the body.
Robot grow_without_genome(const NnGenome& genome, const std::string& name = {});

// Throws InputError unless the network is valid and all its numbers are finite, there are 64 to 65,535 points, alpha is
// finite and >= 0, and the spacing is 0 to 1; with fields 1 or 2 frequencies of 0 to 20 rad/s and an amplitude of 0 to
// 0.4.
void validate(const NnGenome& genome);

// The genome in a robot's origin; none if it was not grown by a network. Throws InputError("/origin/weights/1", ...),
// with the place as a JSON pointer, if the origin is of kind "nn" but cannot be used.
std::optional<NnGenome> nn_genome_of(const Robot& robot);

// The genome as the JSON text of Robot::origin. Weights are written as the shortest decimals that read back as the same
// floats.
std::string to_origin(const NnGenome& genome);

// A genome with a changed network (see mutate and crossover in network.h). A child of two parents keeps the cloud, the
// symmetry, the alpha and the spacing of the first, and the muscles' frequency and amplitude.
NnGenome mutate(const NnGenome& genome, double rate, double size, std::uint64_t seed);
NnGenome crossover(const NnGenome& a, const NnGenome& b, std::uint64_t seed);

// Of a genome with fields: another frequency, amplitude, or both, as mutate_muscles() of painted robots (cppn.h).
NnGenome mutate_muscles(const NnGenome& genome, double strength, std::uint64_t seed, int tail = 0);
// And each of the two from either parent.
NnGenome cross_muscles(const NnGenome& a, const NnGenome& b, std::uint64_t seed);

inline constexpr int min_hidden_width = 6;  // these neurons carry a point's place from layer to layer

enum class NetworkMuscles : std::uint8_t { kinds, fields };

// How random robots are drawn.
struct NnOptions {
  std::vector<int> hidden = {64, 64};  // neurons of each hidden layer
  std::size_t points = 512;            // of the cloud
  float alpha = 0;                     // radius of the alpha shape [m]; 0 = as in NnGenome
  float spacing = 0.6f;                // as in NnGenome; 0 = every point becomes a mass, however near another one is
  double mirrored = 0.5;               // share of robots with mirror symmetry
  NetworkMuscles muscles = NetworkMuscles::kinds;  // each of 20 by its score; or fields
  int frequencies = 1;                             // with fields, as in NnGenome
  float frequency = 5;
  std::string environment;  // as in NnGenome
};

// Throws ParameterError("hidden", "3 is not accepted; ...") and so on unless there are at most 15 hidden layers of 6 to
// 4,096 neurons, 64 to 65,535 points, a finite alpha >= 0, a spacing and a share from 0 to 1.
void validate(const NnOptions& options);

// The genome of the index-th robot of a seed. It depends on options, seed and index alone, bit for bit on every
// machine. Its initial weights are drawn so that bodies differ clearly (nn_features.h). Throws ParameterError as
// validate.
NnGenome random_nn_genome(const NnOptions& options, std::uint64_t seed, std::uint64_t index = 0);

// The robot of that genome, "nn-SEED-INDEX". Throws InputError as grow.
Robot random_nn_robot(const NnOptions& options, std::uint64_t seed, std::uint64_t index = 0);

// Robots first .. first + count - 1 of a seed, grown on all cores. A robot whose cloud is degenerate is left out and
// listed in `failed`; without `failed`, the first such error is thrown.
std::vector<Robot> random_nn_robots(const NnOptions& options, std::uint64_t seed, std::size_t count,
                                    std::uint64_t first = 0, std::vector<FailedRobot>* failed = nullptr);

}  // namespace mercury
