// SPDX-License-Identifier: Apache-2.0
// Voxel robots whose grid is painted by a small network: a compositional pattern-producing network (CPPN; Stanley,
// Genetic Programming and Evolvable Machines 8, 2007). The network sees where a voxel is, and says whether it is there,
// of what kind it is, and when its muscle works; on request also how much it works and how stiff it is. Neighboring
// voxels get similar answers, so bodies and the phases of their muscles are smooth: waves that run through a body are
// what makes it swim.
//
//     x  y  z  distance  bias         the voxel's center, each coordinate between -1 and 1; bias is 1
//      \  \ |   /       /
//      functions of weighted sums     hidden nodes
//        /    |     |      \          weighted sums
//   presence kind phase frequency        and, of fields, amplitude stiffness
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/random_voxel.h"
#include "mercury/robot.h"
#include "mercury/voxel.h"

namespace mercury {

// What a hidden node does with its weighted sum x.
enum class CppnFunction : std::uint8_t {
  linear,    // x
  sine,      // sin(pi x)
  cosine,    // cos(pi x)
  gaussian,  // exp(-4 x^2)
  sigmoid,   // from -1 to 1: 2 / (1 + exp(-5 x)) - 1
  absolute,  // |x|
  square,    // x^2
  root       // sqrt(|x|) with the sign of x
};
inline constexpr std::array<std::string_view, 8> cppn_function_names{"linear",  "sine",     "cosine", "gaussian",
                                                                     "sigmoid", "absolute", "square", "root"};

// The function's value for |x| <= 1e9, the same bits on every machine.
double value_of(CppnFunction function, double x);

// Inputs and outputs are nodes as well; their ids and places are fixed and they stand in no list.
inline constexpr std::uint32_t cppn_inputs = 5;         // ids 0 .. 4: x, y, z, distance, bias
inline constexpr std::uint32_t cppn_phase_outputs = 4;  // ids 5 .. 8: presence, kind, phase, frequency
inline constexpr std::uint32_t cppn_outputs = 6;        // and of fields, the two largest ids: amplitude, stiffness
inline constexpr std::uint32_t first_hidden_id = cppn_inputs + cppn_phase_outputs;
inline constexpr std::uint32_t last_hidden_id = UINT32_MAX - (cppn_outputs - cppn_phase_outputs);
inline constexpr std::uint32_t output_place = 1u << 30;  // of all outputs; that of all inputs is 0

inline constexpr std::size_t max_cppn_nodes = 256;  // hidden
inline constexpr std::size_t max_cppn_edges = 2048;
inline constexpr float max_cppn_weight = 1000;

// A hidden node.
struct CppnNode {
  std::uint32_t id = 0;     // from first_hidden_id to last_hidden_id
  std::uint32_t place = 0;  // between 0 and output_place; edges lead from lower to higher places
  CppnFunction function = CppnFunction::linear;
  friend bool operator==(const CppnNode&, const CppnNode&) = default;
};

struct CppnEdge {
  std::uint32_t from = 0, to = 0;  // ids
  float weight = 0;
  friend bool operator==(const CppnEdge&, const CppnEdge&) = default;
};

// A network without cycles. A node that splits an edge takes the place in the middle of its ends, and its id is a hash
// of theirs. So the same innovation has the same id and place in all networks, without a list of innovations, and nodes
// and edges of any two networks form one without cycles.
struct Cppn {
  std::vector<CppnNode> nodes;  // by (place, id)
  std::vector<CppnEdge> edges;  // by the order of `to`, then of `from`, where nodes are ordered by (place, id)
  std::uint32_t outputs = cppn_phase_outputs;  // or cppn_outputs
  friend bool operator==(const Cppn&, const Cppn&) = default;
};

// Throws InputError("/nodes/3", ...) and so on unless ids differ, places and weights are in their ranges, edges join
// nodes that exist, from a lower to a higher place, each pair once, both lists are in order, there are at most
// max_cppn_nodes and max_cppn_edges of them, and 4 or 6 outputs.
void validate(const Cppn& network);

// The outputs for a point, 0 for those that the network lacks: {x, y, z, distance}; the bias is added. Values of nodes
// are kept between -1e6 and 1e6. The same bits on every machine. Throws InputError as validate.
std::array<double, cppn_outputs> evaluate(const Cppn& network, const std::array<double, cppn_inputs - 1>& point);

// Everything that a robot is grown from.
struct CppnGenome {
  Cppn network;
  int nx = 6, ny = 4, nz = 4;  // of the grid [voxels]
  float edge = 0.1f;           // of a voxel [m]
  Mirror mirror = Mirror::y;   // along this axis the network sees |coordinate|, so the halves are alike
  // Of its muscles, 1 to 5; each has 20 / frequencies phases, evenly over a turn. With fields 1 or 2, of any phase.
  int frequencies = 1;
  float frequency = 5;      // the highest of them [rad/s], 0 to 20; the others are its 1/n, 2/n, ...
  float amplitude = 0.14f;  // of its muscles [1], 0 to 0.4
  std::string environment;  // where the robot belongs ("ocean"), kept in its origin; empty = not recorded
  friend bool operator==(const CppnGenome&, const CppnGenome&) = default;
};

inline constexpr std::size_t max_cppn_cells = std::size_t{1} << 18;

// Throws InputError with the place of what cannot be used unless the network is valid, the grid has 1 to max_cppn_cells
// cells, and the other numbers are in their ranges.
void validate(const CppnGenome& genome);

// The grid that the network paints. A voxel is there if presence > 0. It is muscle if kind > 0, tissue if -1 < kind <=
// 0, else bone. The phase counts in turns: rounded to the phases of the table and wrapped, so that a phase that grows
// over several turns is a traveling wave. The frequency runs from the lowest at -1 to the highest at 1. Muscle number
// f * (20 / frequencies) + p + 1 has frequency f and phase p; with fields all muscles are number 1. Throws InputError
// as validate.
VoxelGrid paint(const CppnGenome& genome);

// The table of materials of such robots: the 20 muscles as above with the stiffness of the default muscles, tissue,
// bone, and their pairs by the ids of combine(). Two muscles of one frequency make the mean of their two sines: with a
// phase between theirs, and an amplitude that is smaller by the cosine of half their difference. (The mean of the
// phases as numbers, which material_table() takes, would be wrong by half a turn where phases go from 2 pi to 0.)
std::vector<Material> cppn_materials(int frequencies, float frequency, float amplitude = 0.14f);

// The largest connected body of the painted grid as a robot (voxel.h) with its own materials; bit for bit the same on
// every machine. With fields each voxel has a phase, an amplitude from 0 at -1 to the largest at 1, and a stiffness
// from half that of its kind at -1 to twice that at 1; voxels that are alike share one of 36 materials, and springs
// between different voxels move by the mean of their waves (robots/muscle_fields.h). Its origin keeps the genome.
// Throws InputError as validate, and for a body that is all air or has more than max_masses masses.
Robot grow(const CppnGenome& genome, const std::string& name = {});

// The voxels of that robot: cells are materials of its table, up to 36 with fields.
VoxelGrid painted_voxels(const CppnGenome& genome);

// The largest body of what is left of the painted grid, after some cells of it were turned to air: with the table of
// the whole robot, and springs that have the material that they have there, where they may have been shared with voxels
// that are lost. Throws InputError for voxels that the robot lacks. The origin is that of a voxel robot.
Robot grow_part(const CppnGenome& genome, const VoxelGrid& part, const std::string& name = {});

// The genome in a robot's origin; none if the robot is of another kind. Throws InputError("/origin/edges/7", ...) if
// the origin is of kind "cppn" but cannot be used.
std::optional<CppnGenome> cppn_genome_of(const Robot& robot);

// The genome as the JSON text of Robot::origin.
std::string to_origin(const CppnGenome& genome);

// A genome with a changed network: weights and functions change, nodes and edges come and go. `strength` scales how
// much (1 = a little, 0 = nothing). The child has a body, and one that differs from the parent's: if it does not,
// another one is drawn, after five with twice the strength, and so on; only if none of 50 children differs, the last of
// them that has a body is returned, or a copy of the parent. Depends on the arguments alone, bit for bit on every
// machine. Throws InputError for a genome that is not valid or a strength that is not finite or below 0.
CppnGenome mutate(const CppnGenome& genome, double strength, std::uint64_t seed);

// A genome with another frequency, by a normal number times `strength` times 0.5 rad/s, or amplitude, by a normal
// number times `strength` times 0.02, or both; with a `tail` by numbers as of mutate_muscle_laws(). It differs unless
// the strength is 0. Throws InputError as mutate.
CppnGenome mutate_muscles(const CppnGenome& genome, double strength, std::uint64_t seed, int tail = 0);

// A child with the grid of a. Each of its nodes is inherited whole, with its function and all edges into it, from
// either parent with probability 1/2 if both have it; so are frequency and amplitude. The child has a body, and one
// that differs from the bodies of both parents; only if none of 50 children does, the last of them that has a body is
// returned, or a copy of a. Depends on the arguments alone. Throws InputError for a genome that is not valid.
CppnGenome crossover(const CppnGenome& a, const CppnGenome& b, std::uint64_t seed);

enum class PaintedMuscles : std::uint8_t { phases, fields };

// How random genomes are drawn.
struct CppnOptions {
  std::array<int, 3> smallest{6, 4, 4}, largest{10, 6, 6};  // [voxels]; each size is drawn between the two
  float edge = 0.1f;                                        // of a voxel [m]
  Mirror mirror = Mirror::y;
  double filled = 0.35;  // smallest share of the grid that is painted; the largest is all of it
  int hidden = 8;        // nodes that the network begins with
  PaintedMuscles muscles = PaintedMuscles::phases;  // fields: networks paint amplitude and stiffness as well
  int frequencies = 1;                              // as in CppnGenome
  float frequency = 5;
  std::string environment;
};

// Throws ParameterError for options out of their range.
void validate(const CppnOptions& options);

// The genome of the index-th robot of a seed, which has a body. It depends on the arguments alone, bit for bit on every
// machine. Throws ParameterError as validate.
CppnGenome random_cppn_genome(const CppnOptions& options, std::uint64_t seed, std::uint64_t index = 0);

// The robot of that genome, "cppn-SEED-INDEX". Throws InputError as grow.
Robot random_cppn_robot(const CppnOptions& options, std::uint64_t seed, std::uint64_t index = 0);

}  // namespace mercury
