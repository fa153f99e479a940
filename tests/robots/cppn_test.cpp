// SPDX-License-Identifier: Apache-2.0
#include "mercury/cppn.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "mercury/error.h"
#include "mercury/fnv.h"
#include "mercury/inspect.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "robots/portable_math.h"
#include "tests/refusal.h"
#include "tests/robots/surface.h"

namespace mercury {
namespace {

using testing::StartsWith;

enum : std::uint32_t { x, y, z, distance, bias, presence, kind, phase, frequency };

// A genome that is muscle everywhere, with these further edges and nodes.
CppnGenome muscle_genome(std::vector<CppnEdge> edges, std::vector<CppnNode> nodes = {}) {
  CppnGenome genome;
  genome.network.nodes = std::move(nodes);
  genome.network.edges = {{bias, presence, 1}, {bias, kind, 1}};
  genome.network.edges.insert(genome.network.edges.end(), edges.begin(), edges.end());
  return genome;
}

VoxelGrid body_of(const CppnGenome& genome) { return largest_body(paint(genome)); }

bool has_body(const VoxelGrid& body) {
  return std::ranges::any_of(body.cells, [](MaterialId cell) { return cell != air; });
}

TEST(PortableMath, ExponentialAgreesWithTheLibrarysToFourUlp) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const double at = random.uniform(-700, 700);
    const auto exact = std::exp(static_cast<long double>(at));
    const double ulp = std::nextafter(static_cast<double>(exact), INFINITY) - static_cast<double>(exact);
    EXPECT_LE(std::abs(static_cast<double>(static_cast<long double>(portable_exp(at)) - exact)), 4 * ulp) << at;
  }
  EXPECT_EQ(portable_exp(0), 1);
  EXPECT_EQ(portable_exp(-1e12), 0);
}

TEST(CppnFunctions, AreWhatTheirNamesSay) {
  for (double at = -3; at < 3; at += 0.0137) {
    EXPECT_NEAR(value_of(CppnFunction::linear, at), at, 1e-15);
    EXPECT_NEAR(value_of(CppnFunction::sine, at), std::sin(std::numbers::pi * at), 2e-15);
    EXPECT_NEAR(value_of(CppnFunction::cosine, at), std::cos(std::numbers::pi * at), 2e-15);
    EXPECT_NEAR(value_of(CppnFunction::gaussian, at), std::exp(-4 * at * at), 1e-15);
    EXPECT_NEAR(value_of(CppnFunction::sigmoid, at), std::tanh(2.5 * at), 1e-15);
    EXPECT_NEAR(value_of(CppnFunction::absolute, at), std::abs(at), 1e-15);
    EXPECT_NEAR(value_of(CppnFunction::square, at), at * at, 1e-15);
    EXPECT_NEAR(value_of(CppnFunction::root, at), std::copysign(std::sqrt(std::abs(at)), at), 1e-15);
  }
}

TEST(Cppn, SumsAlongItsEdges) {
  Cppn network;
  network.nodes = {{20, 100, CppnFunction::gaussian}, {12, 200, CppnFunction::square}};
  network.edges = {{x, 20, 2},    {bias, 20, -0.5f},        {y, 12, 3},
                   {20, 12, 1},   {distance, presence, -1}, {12, presence, 0.25f},
                   {20, phase, 7}};
  ASSERT_NO_THROW(validate(network));
  const auto outputs = evaluate(network, {0.3, -0.2, 0.9, 0.1});
  const double first = std::exp(-4 * std::pow(2 * 0.3 - 0.5, 2)), second = std::pow(3 * -0.2 + first, 2);
  EXPECT_NEAR(outputs[0], -0.1 + second / 4, 1e-14);
  EXPECT_EQ(outputs[1], 0);
  EXPECT_NEAR(outputs[2], 7 * first, 1e-14);
  EXPECT_EQ(outputs[3], 0);
}

TEST(Cppn, StaysFiniteWhereSquaresOfSquaresWouldOverflow) {
  Cppn network;
  for (std::uint32_t i = 0; i < 40; ++i) {
    network.nodes.push_back({9 + i, 1 + i, CppnFunction::square});
    network.edges.push_back({i == 0 ? std::uint32_t{x} : 8 + i, 9 + i, 1000});
  }
  network.edges.push_back({48, presence, -1000});
  EXPECT_EQ(evaluate(network, {1, 1, 1, 1})[0], -1e6);
}

TEST(CppnPaint, AGrowingPhaseIsATravelingWave) {
  CppnGenome genome = muscle_genome({{x, phase, 1.5f}});
  genome.nx = 30;
  const VoxelGrid grid = paint(genome);
  for (int i = 0; i < 30; ++i) {
    const double turns = 1.5 * (2 * i + 1 - 30) / 30;  // from -1.45 to 1.45
    const double steps = 20 * turns;
    const double painted = grid.at(i, 0, 0) - 1;
    EXPECT_NEAR(std::remainder(painted - steps, 20), 0, 0.5 + 1e-9) << i;
    for (int k = 0; k < grid.nz; ++k) EXPECT_EQ(grid.at(i, 2, k), grid.at(i, 0, 0));
  }
}

TEST(CppnPaint, OutputsChooseBetweenAirMuscleTissueAndBone) {
  CppnGenome genome = muscle_genome({});
  genome.network.edges = {{x, presence, 1}, {y, kind, 2}};
  genome.mirror = Mirror::none;
  genome.ny = 4;  // y = -0.75, -0.25, 0.25, 0.75
  const VoxelGrid grid = paint(genome);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(grid.at(i, 0, 0), air);
  EXPECT_EQ(grid.at(4, 0, 0), bone);
  EXPECT_EQ(grid.at(4, 1, 0), tissue);
  EXPECT_EQ(grid.at(4, 2, 0), 1);
  genome = muscle_genome({{x, frequency, 1.2f}});
  genome.frequencies = 2;
  EXPECT_EQ(paint(genome).at(0, 0, 0), 1);
  EXPECT_EQ(paint(genome).at(5, 0, 0), 11);
}

TEST(CppnPaint, HalvesAreAlikeAlongTheMirror) {
  for (const Mirror mirror : {Mirror::x, Mirror::y, Mirror::z})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const VoxelGrid grid = paint(random_cppn_genome({.mirror = mirror}, seed));
      for (int k = 0; k < grid.nz; ++k)
        for (int j = 0; j < grid.ny; ++j)
          for (int i = 0; i < grid.nx; ++i)
            ASSERT_EQ(grid.at(i, j, k),
                      grid.at(mirror == Mirror::x ? grid.nx - 1 - i : i, mirror == Mirror::y ? grid.ny - 1 - j : j,
                              mirror == Mirror::z ? grid.nz - 1 - k : k));
    }
}

double sine_of(const Material& material, double time) {
  return static_cast<double>(material.amplitude) *
         std::sin(static_cast<double>(material.frequency) * time + static_cast<double>(material.phase));
}

TEST(CppnMaterials, APairOfMusclesMovesAsTheMeanOfBoth) {
  for (const int frequencies : {1, 2, 3, 4, 5}) {
    const std::vector<Material> table = cppn_materials(frequencies, 5, 0.2f);
    ASSERT_EQ(table.size(), 254u);
    for (MaterialId i = 1; i <= base_material_count; ++i)
      for (MaterialId j = 1; j <= base_material_count; ++j) {
        const Material &a = table[i], &b = table[j], &pair = table[combine(i, j)];
        ASSERT_TRUE(is_valid(pair));
        EXPECT_FLOAT_EQ(pair.stiffness, (a.stiffness + b.stiffness) / 2);
        if (a.amplitude != 0 && b.amplitude != 0 && a.frequency != b.frequency) continue;
        for (const double time : {0., 0.1, 0.35, 0.8})
          EXPECT_NEAR(sine_of(pair, time), (sine_of(a, time) + sine_of(b, time)) / 2, 1e-7) << i + 0 << ' ' << j + 0;
      }
  }
}

TEST(CppnMaterials, MusclesHaveEvenPhasesAndFrequencies) {
  const std::vector<Material> table = cppn_materials(4, 6);
  for (MaterialId id = 1; id <= muscle_count; ++id) {
    EXPECT_FLOAT_EQ(table[id].frequency, 1.5f * static_cast<float>((id - 1) / 5 + 1));
    EXPECT_NEAR(table[id].phase, 2 * std::numbers::pi * ((id - 1) % 5) / 5, 1e-6);
    EXPECT_EQ(table[id].stiffness, default_materials()[id].stiffness);
    EXPECT_EQ(table[id].amplitude, default_materials()[id].amplitude);
  }
}

TEST(CppnRobots, AreSoundAndGrowAgainFromTheirOrigin) {
  for (std::uint64_t index = 0; index < 60; ++index) {
    const Robot robot = random_cppn_robot({.environment = "ocean"}, 1, index);
    ASSERT_NO_THROW(validate(robot));
    ASSERT_TRUE(half_edges_cancel(robot)) << index;
    ASSERT_TRUE(every_spring_is_there_once(robot)) << index;
    ASSERT_EQ(spring_components(robot), 1u) << index;
    const auto genome = cppn_genome_of(robot);
    ASSERT_TRUE(genome.has_value());
    EXPECT_EQ(*genome, random_cppn_genome({.environment = "ocean"}, 1, index));
    EXPECT_EQ(grow(*genome, robot.name), robot);
  }
}

TEST(CppnRobots, HaveTheSameBitsOnEveryMachine) {
  // FNV-1a over the cells of random robots and of their mutants; the four operations and square roots alone lead to
  // them.
  Fnv1a hash;
  for (std::uint64_t index = 0; index < 40; ++index) {
    const CppnGenome genome = random_cppn_genome({}, 1, index);
    for (const CppnGenome& one : {genome, mutate(genome, 1, index)}) {
      for (const MaterialId cell : paint(one).cells) hash.step(cell);
      for (const CppnEdge& edge : one.network.edges) hash.step(std::bit_cast<std::uint32_t>(edge.weight));
    }
  }
  EXPECT_EQ(hash.value(), 393581272255519242u);
}

TEST(CppnRobots, RandomOnesAreFilledAsAskedAndMostlyMuscle) {
  double least = 1, most = 0;
  std::vector<VoxelGrid> bodies;
  for (std::uint64_t index = 0; index < 200; ++index) {
    const VoxelGrid body = body_of(random_cppn_genome({}, 2, index));
    const auto count = [&](auto counts) { return static_cast<double>(std::ranges::count_if(body.cells, counts)); };
    const double voxels = count([](MaterialId cell) { return cell != air; });
    const double filled = voxels / static_cast<double>(body.cells.size());
    least = std::min(least, filled);
    most = std::max(most, filled);
    EXPECT_GE(count([](MaterialId cell) { return cell != air && cell <= muscle_count; }), 0.4 * voxels) << index;
    EXPECT_EQ(std::ranges::count(bodies, body), 0) << index;
    bodies.push_back(body);
  }
  EXPECT_GE(least, 0.2);
  EXPECT_LT(least, 0.4);
  EXPECT_GT(most, 0.9);
}

TEST(CppnRobots, TheSmallestGridsHaveBodies) {
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    for (const std::array<int, 3> size : {std::array{1, 1, 1}, std::array{2, 1, 1}, std::array{1, 2, 3}})
      EXPECT_TRUE(has_body(body_of(random_cppn_genome({.smallest = size, .largest = size}, seed))));
}

TEST(CppnMutation, ChildrenHaveBodiesOfTheirOwn) {
  for (std::uint64_t index = 0; index < 20; ++index) {
    const CppnGenome parent = random_cppn_genome({}, 3, index);
    const VoxelGrid body = body_of(parent);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const CppnGenome child = mutate(parent, seed % 2 == 0 ? 1 : 0.01, seed);
      ASSERT_NO_THROW(validate(child));
      ASSERT_TRUE(has_body(body_of(child)));
      ASSERT_NE(body_of(child), body);
      ASSERT_EQ(child, mutate(parent, seed % 2 == 0 ? 1 : 0.01, seed));
    }
    EXPECT_EQ(mutate(parent, 0, 7), parent);
  }
}

TEST(CppnMutation, ChangesWeightsFunctionsNodesAndEdges) {
  const CppnGenome parent = random_cppn_genome({}, 3);
  int weights = 0, functions = 0, more_nodes = 0, fewer_nodes = 0, more_edges = 0, fewer_edges = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Cppn &before = parent.network, after = mutate(parent, 1, seed).network;
    weights += after.edges != before.edges;
    for (const CppnNode& node : after.nodes) {
      const auto same = std::ranges::find(before.nodes, node.id, &CppnNode::id);
      functions += same != before.nodes.end() && same->function != node.function;
      if (same != before.nodes.end()) {
        EXPECT_EQ(same->place, node.place);
      }
    }
    more_nodes += after.nodes.size() > before.nodes.size();
    fewer_nodes += after.nodes.size() < before.nodes.size();
    more_edges += after.edges.size() > before.edges.size();
    fewer_edges += after.edges.size() < before.edges.size();
  }
  EXPECT_GT(weights, 150);
  for (const int count : {functions, more_nodes, fewer_nodes, more_edges, fewer_edges}) EXPECT_GT(count, 5);
}

TEST(CppnMutation, OfMusclesLeavesTheBody) {
  const CppnGenome parent = random_cppn_genome({}, 3);
  for (const double strength : {1e-9, 1., 100.})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const CppnGenome child = mutate_muscles(parent, strength, seed);
      ASSERT_NO_THROW(validate(child));
      EXPECT_EQ(child.network, parent.network);
      EXPECT_TRUE(child.frequency != parent.frequency || child.amplitude != parent.amplitude);
    }
  EXPECT_EQ(mutate_muscles(parent, 0, 3), parent);
}

TEST(CppnCrossover, EachNodeIsInheritedWholeFromOneParent) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const CppnGenome a = random_cppn_genome({}, 5, seed), b = mutate(random_cppn_genome({}, 6, seed), 2, seed);
    const CppnGenome child = crossover(a, b, seed);
    ASSERT_NO_THROW(validate(child));
    ASSERT_TRUE(body_of(child) != body_of(a) && body_of(child) != body_of(b));
    EXPECT_EQ(child.nx, a.nx);
    const auto inputs_of = [](const Cppn& network, std::uint32_t id) {
      std::vector<CppnEdge> edges;
      std::ranges::copy_if(network.edges, std::back_inserter(edges),
                           [&](const CppnEdge& edge) { return edge.to == id; });
      return edges;
    };
    std::vector<std::uint32_t> ids{presence, kind, phase, frequency};
    for (const CppnNode& node : child.network.nodes) ids.push_back(node.id);
    for (const std::uint32_t id : ids) {
      const auto inherited = inputs_of(child.network, id);
      EXPECT_TRUE(inherited == inputs_of(a.network, id) || inherited == inputs_of(b.network, id)) << seed << ' ' << id;
    }
  }
}

TEST(CppnEvolution, ManyGenerationsStayValidWithoutCycles) {
  CppnGenome a = random_cppn_genome({}, 8, 0), b = random_cppn_genome({}, 8, 1);
  for (std::uint64_t generation = 0; generation < 400; ++generation) {
    const CppnGenome child = crossover(mutate(a, 3, generation), b, generation);
    b = mutate(a, 3, generation + 1000);
    a = child;
    ASSERT_NO_THROW(validate(a)) << generation;  // each edge leads upward
    ASSERT_TRUE(has_body(body_of(a)));
  }
  EXPECT_LE(a.network.nodes.size(), max_cppn_nodes);
}

TEST(CppnOrigin, RefusesWhatCannotBeUsedAndSaysWhere) {
  const auto read = [](const std::string& origin) {
    Robot robot;
    robot.origin = origin;
    return refusal([&] { cppn_genome_of(robot); });
  };
  const auto origin = [](const std::string& size, const std::string& nodes, const std::string& edges) {
    return R"({"kind":"cppn","size":)" + size +
           R"(,"edge":0.1,"mirror":"y","frequencies":1,"frequency":5,"amplitude":0.1,"nodes":)" + nodes +
           R"(,"edges":)" + edges + "}";
  };
  EXPECT_EQ(read(origin("[6,4,4]", "[]", "[[4,5,1]]")), "");
  EXPECT_EQ(read(R"({"kind":"voxel"})"), "");
  EXPECT_EQ(read("[]"), "/origin: a JSON object is expected");
  EXPECT_EQ(read(R"({"kind":"cppn"})"), "/origin/size: is missing");
  EXPECT_EQ(read(origin("[6,4]", "[]", "[]")), "/origin/size: three whole numbers are expected");
  EXPECT_EQ(read(origin("[6,4,-1]", "[]", "[]")), "/origin/size/2: a whole number >= 0 is expected");
  EXPECT_EQ(read(origin("[60000,60000,60000]", "[]", "[]")), "/origin/size: give at most 262144 voxels");
  EXPECT_EQ(read(origin("[6,0,4]", "[]", "[]")), "/origin/size: give at least 1 voxel each way");
  EXPECT_EQ(read(origin("[6,4,4]", "[[9,5,\"tan\"]]", "[]")),
            "/origin/nodes/0/2: give linear, sine, cosine, gaussian, sigmoid, absolute, square or root");
  EXPECT_EQ(read(origin("[6,4,4]", "[[3,5,\"sine\"]]", "[]")), "/origin/nodes/0: id 3 is taken; give 9 to 4294967293");
  EXPECT_EQ(read(origin("[6,4,4]", "[[9,5,\"sine\"],[10,4,\"sine\"]]", "[]")),
            "/origin/nodes/1: nodes must be in the order of place, then id");
  EXPECT_EQ(read(origin("[6,4,4]", "[[9,5,\"sine\"],[9,6,\"sine\"]]", "[]")), "/origin/nodes/1: id 9 stands twice");
  EXPECT_EQ(read(origin("[6,4,4]", "[]", "[[4,5]]")), "/origin/edges/0: a list of three is expected");
  EXPECT_EQ(read(origin("[6,4,4]", "[]", "[[4,77,1]]")), "/origin/edges/0: there is no node 77");
  EXPECT_EQ(read(origin("[6,4,4]", "[]", "[[5,4,1]]")), "/origin/edges/0: must lead from a lower to a higher place");
  EXPECT_EQ(read(origin("[6,4,4]", "[]", "[[4,5,1e30]]")),
            "/origin/edges/0: the weight must be a number from -1000 to 1000");
  EXPECT_EQ(read(origin("[6,4,4]", "[]", "[[4,5,1],[4,5,1]]")),
            "/origin/edges/1: edges must be in the order of their ends, each once");
  EXPECT_THAT(refusal([] { grow(muscle_genome({{bias, frequency, 1}, {bias, phase, 1}})); }), StartsWith("/edges/3"));
  CppnGenome nothing = muscle_genome({});
  nothing.network.edges[0].weight = -1;
  EXPECT_EQ(refusal([&] { grow(nothing); }), "voxel grid: all voxels are air, a robot needs at least one that is not");
}

TEST(CppnOrigin, DamagedOnesGiveAGenomeOrALine) {
  const std::string sound = random_cppn_robot({}, 1).origin;
  int used = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    Random random(seed);
    Robot robot;
    robot.origin = sound;
    for (std::uint64_t edits = 1 + random.below(3); edits > 0 && !robot.origin.empty(); --edits) {
      const auto at = static_cast<std::size_t>(random.below(robot.origin.size()));
      constexpr std::string_view characters = "0123456789-.,[]{}\"e";
      if (random.chance(0.7))
        robot.origin[at] = characters[static_cast<std::size_t>(random.below(characters.size()))];
      else
        robot.origin.erase(at, random.below(8));
    }
    try {
      if (const auto genome = cppn_genome_of(robot)) {
        ASSERT_NO_THROW(validate(*genome)) << seed;
        ++used;
      }
    } catch (const InputError& error) {
      ASSERT_LT(std::string(error.what()).size(), 250u);
      ++refused;
    }
  }
  EXPECT_GT(used, 300);
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace mercury
