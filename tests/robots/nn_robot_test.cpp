#include "robots/nn_robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "robots/random.h"
#include "sim/error.h"

namespace mercury {
namespace {

double volume_of(const Robot& robot) {
  double six_volumes = 0;
  for (const Face& f : robot.faces) {
    const Vec3 a = robot.masses[f.a], b = robot.masses[f.b], c = robot.masses[f.c];
    six_volumes += dot(cross(a, b), c);
  }
  return six_volumes / 6;
}

std::size_t reachable_masses(const Robot& robot) {
  std::vector<std::vector<std::uint16_t>> joined(robot.masses.size());
  for (const Spring& s : robot.springs) {
    joined[s.a].push_back(s.b);
    joined[s.b].push_back(s.a);
  }
  std::set<std::uint16_t> reached = {0};
  std::vector<std::uint16_t> next = {0};
  while (!next.empty()) {
    const std::uint16_t mass = next.back();
    next.pop_back();
    for (const std::uint16_t other : joined[mass])
      if (reached.insert(other).second) next.push_back(other);
  }
  return reached.size();
}

// Number of edges with more than two faces; every edge must have as many faces one way as the other.
int check_closed_and_oriented(const Robot& robot) {
  std::map<std::pair<std::uint16_t, std::uint16_t>, int> half_edges;
  for (const Face& f : robot.faces) {
    ++half_edges[{f.a, f.b}];
    ++half_edges[{f.b, f.c}];
    ++half_edges[{f.c, f.a}];
  }
  int pinched = 0;
  for (const auto& [edge, count] : half_edges) {
    const auto opposite = half_edges.find({edge.second, edge.first});
    EXPECT_TRUE(opposite != half_edges.end() && opposite->second == count)
        << "edge " << edge.first << "-" << edge.second << " is open";
    pinched += count > 1 && edge.first < edge.second;
  }
  return pinched;
}

int check_body(const Robot& robot) {
  EXPECT_NO_THROW(validate(robot));
  EXPECT_GE(robot.faces.size(), 4u);
  EXPECT_GT(volume_of(robot), 0);
  EXPECT_EQ(reachable_masses(robot), robot.masses.size());
  std::set<std::pair<std::uint16_t, std::uint16_t>> pairs;
  for (const Spring& s : robot.springs) {
    EXPECT_TRUE(pairs.insert(std::minmax(s.a, s.b)).second) << "two springs join " << s.a << " and " << s.b;
    EXPECT_EQ(s.rest_length, rest_distance(robot, s.a, s.b));
  }
  double farthest = 0;
  for (const Vec3& x : robot.masses) farthest = std::max(farthest, static_cast<double>(length(x)));
  EXPECT_LE(farthest, 1);
  return check_closed_and_oriented(robot);
}

// A network of one hidden layer, whose places are a linear function of max(0, x) and max(0, -x).
NnGenome simple_genome(const std::vector<std::vector<float>>& of_positive,
                       const std::vector<std::vector<float>>& of_negative) {
  Layer split{3, 6, std::vector<float>(18, 0.f), std::vector<float>(6, 0.f)};
  for (std::size_t i = 0; i < 3; ++i) {
    split.weights[i * 3 + i] = 1;
    split.weights[(i + 3) * 3 + i] = -1;
  }
  Layer last{6, 25, std::vector<float>(6 * 25, 0.f), std::vector<float>(25, 0.f)};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      last.weights[row * 6 + column] = of_positive[row][column];
      last.weights[row * 6 + 3 + column] = of_negative[row][column];
    }
  NnGenome genome;
  genome.network.layers = {split, last};
  genome.cloud_seed = 1;
  genome.points = 200;
  return genome;
}
const std::vector<std::vector<float>> identity = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<std::vector<float>> minus_identity = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
const std::vector<std::vector<float>> nothing = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

std::string reason_not_to_grow(const NnGenome& genome) {
  try {
    grow(genome);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NnRobot, BodiesOf500SeedsAreClosedSolidAndWhole) {
  int pinched = 0;
  for (const Robot& robot : random_nn_robots({.points = 96}, 1, 488)) pinched += check_body(robot);
  for (const Robot& robot : random_nn_robots({}, 2, 12)) {
    pinched += check_body(robot);
    EXPECT_EQ(robot.masses.size(), 512u);
  }
  RecordProperty("edges_with_more_than_two_faces", pinched);
}

TEST(NnRobot, HoldsWithAChosenAlphaToo) {
  std::vector<FailedRobot> failed;
  const auto robots = random_nn_robots({.points = 200, .alpha = 0.12f}, 3, 30, 0, &failed);
  EXPECT_GT(robots.size(), 20u);
  EXPECT_EQ(robots.size() + failed.size(), 30u);
  std::size_t smaller = 0;
  for (const Robot& robot : robots) {
    check_body(robot);
    smaller += robot.masses.size() < 200;
  }
  EXPECT_GT(smaller, 5u);  // stray points are left out
}

TEST(NnRobot, SpringsCombineTheMaterialsThatTheNetworkGivesTheirMasses) {
  // Score of material 7 is x, of material 21 is -x; the place is the point.
  NnGenome genome = simple_genome(identity, minus_identity);
  auto& weights = genome.network.layers[1].weights;
  weights[(3 + 6) * 6 + 0] = 1;
  weights[(3 + 20) * 6 + 3] = 1;
  const Robot robot = grow(genome);
  check_body(robot);
  EXPECT_EQ(robot.masses.size(), 200u);
  // The centre moved by the mean only: the mass's side is told by any of its springs that are pure.
  std::map<std::uint16_t, std::set<MaterialId>> of_mass;
  std::set<MaterialId> materials;
  for (const Spring& s : robot.springs) {
    materials.insert(s.material);
    if (s.material == 7 || s.material == 21) of_mass[s.a].insert(s.material), of_mass[s.b].insert(s.material);
  }
  EXPECT_EQ(materials, (std::set<MaterialId>{7, 21, combine(7, 21)}));
  float lowest_of_7 = 1, highest_of_21 = -1;
  for (const auto& [mass, own] : of_mass) {
    ASSERT_EQ(own.size(), 1u);
    const float x = robot.masses[mass].x;
    if (own.contains(7)) lowest_of_7 = std::min(lowest_of_7, x);
    else highest_of_21 = std::max(highest_of_21, x);
  }
  EXPECT_GT(lowest_of_7, highest_of_21);
  for (const Spring& s : robot.springs) {
    const auto side = [&](std::uint16_t mass) { return robot.masses[mass].x > (lowest_of_7 + highest_of_21) / 2; };
    const bool mixed = s.material == combine(7, 21);
    if (of_mass.contains(s.a) && of_mass.contains(s.b)) {
      EXPECT_EQ(mixed, side(s.a) != side(s.b));
    }
  }
}

TEST(NnRobot, PlacesAreCentredAndReachTheUnitSphere) {
  const Robot robot = grow(simple_genome(identity, minus_identity));
  double mean[3] = {}, farthest = 0;
  for (const Vec3& x : robot.masses) {
    mean[0] += x.x, mean[1] += x.y, mean[2] += x.z;
    farthest = std::max(farthest, static_cast<double>(length(x)));
  }
  for (const double m : mean) EXPECT_NEAR(m / 200, 0, 1e-6);
  EXPECT_NEAR(farthest, 1, 1e-5);
}

TEST(NnRobot, NeighboursInSpaceAreNearInMemory) {
  const Robot robot = grow(random_nn_genome({}, 4));
  double distance = 0;
  for (const Spring& s : robot.springs) distance += std::abs(s.a - s.b);
  // Two of 512 numbers drawn at random are 171 apart.
  EXPECT_LT(distance / static_cast<double>(robot.springs.size()), 85);
}

TEST(NnRobot, ASavedGenomeGrowsTheIdenticalRobot) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Robot robot = grow(random_nn_genome({.points = 100, .alpha = seed % 2 ? 0.4f : 0.f}, seed), "x");
    const auto genome = nn_genome_of(robot);
    ASSERT_TRUE(genome);
    EXPECT_EQ(*genome, random_nn_genome({.points = 100, .alpha = seed % 2 ? 0.4f : 0.f}, seed));
    EXPECT_EQ(grow(*genome, "x"), robot);
  }
}

// FNV-1a over all bits of a body.
std::uint64_t hash_of(const Robot& robot) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](std::uint32_t value) {
    for (int byte = 0; byte < 4; ++byte) hash = (hash ^ (value >> 8 * byte & 0xff)) * 0x100000001b3u;
  };
  for (const Vec3& x : robot.masses)
    for (const float c : {x.x, x.y, x.z}) add(std::bit_cast<std::uint32_t>(c));
  for (const Spring& s : robot.springs) add(s.a), add(s.b), add(s.material), add(std::bit_cast<std::uint32_t>(s.rest_length));
  for (const Face& f : robot.faces) add(f.a), add(f.b), add(f.c);
  return hash;
}

// Not what is right but that it is the same: these hashes hold for every compiler, optimization and machine.
TEST(NnRobot, ASeedGrowsTheSameBitsEverywhere) {
  EXPECT_EQ(hash_of(grow(random_nn_genome({}, 1))), 15080024903124239027u);
  EXPECT_EQ(hash_of(grow(random_nn_genome({.hidden = {20, 30, 40}, .points = 300, .mirrored = 1}, 2))), 18007120144977833535u);
  EXPECT_EQ(hash_of(grow(random_nn_genome({.hidden = {}, .points = 3000, .alpha = 0.15f}, 3))), 8435448039254982332u);
}

TEST(NnRobot, EveryFloatComesBackFromTheOrigin) {
  NnGenome genome = simple_genome(identity, identity);
  Random random(6);
  genome.network.layers = {Layer{400, 25, std::vector<float>(400 * 25), std::vector<float>(25)}};
  for (float& weight : genome.network.layers[0].weights) {
    do weight = std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
    while (!std::isfinite(weight));
  }
  auto& weights = genome.network.layers[0].weights;
  weights[0] = -0.f;
  weights[1] = std::numeric_limits<float>::denorm_min();
  weights[2] = std::numeric_limits<float>::max();
  genome.cloud_seed = ~std::uint64_t{0};
  Robot robot;
  robot.origin = to_origin(genome);
  const auto back = nn_genome_of(robot);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->cloud_seed, genome.cloud_seed);
  for (std::size_t i = 0; i < weights.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(back->network.layers[0].weights[i]), std::bit_cast<std::uint32_t>(weights[i]));
}

TEST(NnRobot, OriginsThatCannotBeUsedAreRefusedWithTheirPlace) {
  const auto read = [](const std::string& origin) -> std::string {
    Robot robot;
    robot.origin = origin;
    try {
      return nn_genome_of(robot) ? "genome" : "none";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(read(""), "none");
  EXPECT_EQ(read(R"({"kind":"voxel"})"), "none");
  EXPECT_EQ(read("[1]"), "/origin: a JSON object is expected");
  EXPECT_EQ(read("{"), "/origin: a JSON object is expected");
  EXPECT_EQ(read(R"({"kind":"nn"})"), "/origin/weights: is missing");

  NnGenome genome = simple_genome(identity, identity);
  std::string origin = to_origin(genome);
  EXPECT_EQ(read(origin), "genome");
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = origin;
    text.replace(text.find(from), from.size(), to);
    return read(text);
  };
  EXPECT_EQ(replaced("[3,6,25]", "[3,7,25]"), "/origin/sizes: the sizes of the layers in weights are expected");
  EXPECT_EQ(replaced("[[1,0,0]", "[[1,0]"), "/origin/weights/0: rows of equal length are expected");
  EXPECT_EQ(replaced("[[1,0,0]", "[[1,0,\"a\"]"), "/origin/weights/0/0: numbers are expected");
  EXPECT_EQ(replaced("\"points\":200", "\"points\":20"), "/origin: points: 20 is not accepted; give 64 to 65535");
  EXPECT_EQ(replaced("\"points\":200", "\"points\":-1"), "/origin/points: a whole number >= 0 is expected");
  EXPECT_EQ(replaced("\"mirrored\":false", "\"mirrored\":0"), "/origin/mirrored: true or false is expected");
  EXPECT_EQ(replaced("\"alpha\":0", "\"alpha\":-1"), "/origin: alpha: give a radius > 0 m, or 0 for the smallest that holds all points");
}

TEST(NnRobot, CloudsThatSpanNoBodyAreRefusedWithTheReason) {
  EXPECT_EQ(reason_not_to_grow(simple_genome(nothing, nothing)),
            "cloud: the network puts all its points on one place");
  EXPECT_EQ(reason_not_to_grow(simple_genome({{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, {{-1, 0, 0}, {0, -1, 0}, {0, 0, 0}})),
            "cloud: its points lie in one plane, they span no body");
  EXPECT_EQ(reason_not_to_grow(simple_genome({{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, nothing)),
            "cloud: its points lie in one plane, they span no body");
  NnGenome overflowing = simple_genome(identity, minus_identity);
  overflowing.network.layers[0].weights.assign(18, 3e38f);
  EXPECT_EQ(reason_not_to_grow(overflowing), "cloud: the network gives places that are not finite");
  NnGenome far_away = simple_genome(identity, minus_identity);
  far_away.network.layers[1].biases[0] = 1e7f;
  EXPECT_EQ(reason_not_to_grow(far_away), "cloud: the network puts all its points on one place");
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    NnGenome genome = simple_genome(identity, minus_identity);
    genome.network.layers[0].weights[4] = bad;
    EXPECT_EQ(reason_not_to_grow(genome), "network: a weight is not a finite number");
  }
  NnGenome genome = simple_genome(identity, minus_identity);
  genome.alpha = 1e-4f;
  EXPECT_EQ(reason_not_to_grow(genome), "alpha: no tetrahedron of the cloud is as small as the given radius");
  genome.alpha = -1;
  EXPECT_EQ(reason_not_to_grow(genome), "alpha: give a radius > 0 m, or 0 for the smallest that holds all points");
  genome.alpha = 0;
  genome.points = 63;
  EXPECT_EQ(reason_not_to_grow(genome), "points: 63 is not accepted; give 64 to 65535");
}

TEST(NnRobot, PointsOnOnePlaceAreOneMass) {
  // An eighth of all points goes to the corner, an eighth of the rest onto each of three edges, ...
  const Robot robot = grow(simple_genome(identity, nothing));
  check_body(robot);
  EXPECT_GT(robot.masses.size(), 150u);
  EXPECT_LT(robot.masses.size(), 195u);
}

TEST(NnRobot, PointsTooCloseForSpringsLeaveAWholeBody) {
  // Some points are thrown far out along x, the others lie ever closer together: first springs are left out, then
  // masses that lost them all, and the tetrahedra that need those.
  std::set<std::size_t> masses;
  for (float spread = 1e-2f; spread > 1e-7f; spread *= 0.7f) {
    NnGenome genome = simple_genome({{spread, 0, 0}, {0, spread, 0}, {0, 0, spread}},
                                    {{-spread, 0, 0}, {0, -spread, 0}, {0, 0, -spread}});
    genome.network.layers[0].biases[0] = -1.5f;
    genome.network.layers[1].weights[0] = 1;
    const Robot robot = grow(genome);
    check_body(robot);
    masses.insert(robot.masses.size());
  }
  EXPECT_EQ(*masses.rbegin(), 200u);
  EXPECT_LT(*masses.begin(), 150u);
  EXPECT_GT(masses.size(), 3u);
}

TEST(NnRobot, OneOfAPopulationDoesNotDependOnTheOthers) {
  const NnOptions options{.points = 80};
  const auto many = random_nn_robots(options, 5, 9), few = random_nn_robots(options, 5, 4);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i], many[i]);
  EXPECT_EQ(few[3], grow(random_nn_genome(options, 5, 3), "nn-5-3"));
  EXPECT_EQ(random_nn_robots(options, 5, 2, 7)[1], many[8]);
  EXPECT_NE(many[0].masses, random_nn_robots(options, 6, 1)[0].masses);
}

TEST(NnRobot, AFailureIsToldAndTheOthersGoOn) {
  std::vector<FailedRobot> failed;
  EXPECT_TRUE(random_nn_robots({.points = 64, .alpha = 1e-6f}, 1, 5, 10, &failed).empty());
  ASSERT_EQ(failed.size(), 5u);
  EXPECT_EQ(failed[4].index, 14u);
  EXPECT_EQ(failed[4].reason, "alpha: no tetrahedron of the cloud is as small as the given radius");
  EXPECT_THROW(random_nn_robots({.points = 64, .alpha = 1e-6f}, 1, 5), InputError);
}

TEST(NnRobot, OptionsOutOfRangeAreNamed) {
  const auto message = [](const NnOptions& options) -> std::string {
    try {
      random_nn_robots(options, 1, 1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({.hidden = {64, 3}}), "--hidden: 3 is not accepted; give 6 to 4096 neurons a layer");
  EXPECT_EQ(message({.hidden = std::vector<int>(16, 8)}), "--hidden: 16 is not accepted; give at most 15 layers");
  EXPECT_EQ(message({.points = 63}), "--points: 63 is not accepted; give 64 to 65535");
  EXPECT_EQ(message({.points = 65536}), "--points: 65536 is not accepted; give 64 to 65535");
  EXPECT_EQ(message({.alpha = -0.5f}),
            "--alpha: -0.5 is not accepted; give a radius > 0 m, or 0 for the smallest that holds all points");
  EXPECT_EQ(message({.mirrored = 2}), "--mirrored: 2 is not accepted; give a share from 0 to 1");
}

TEST(NnRobot, SizesOfTheNetworkAreFree) {
  for (const std::vector<int>& hidden : {std::vector<int>{}, {6}, {17}, {64}, {7, 40, 9}, {64, 64, 64, 64}}) {
    const Robot robot = grow(random_nn_genome({.hidden = hidden, .points = 100, .mirrored = 1}, 7));
    check_body(robot);
    EXPECT_EQ(sizes_of(nn_genome_of(robot)->network).size(), hidden.size() + 2);
  }
  // Another number of inputs than three.
  NnGenome genome = random_nn_genome({.points = 100}, 8);
  Layer& first = genome.network.layers[0];
  first.inputs = 4;
  Random random(9);
  first.weights.resize(4 * 64);
  for (float& weight : first.weights) weight = static_cast<float>(random.normal());
  check_body(grow(genome));
}

TEST(NnRobot, AMirroredBodyIsItsOwnMirrorImage) {
  const Robot robot = grow(random_nn_genome({.points = 300, .mirrored = 1}, 10));
  const auto has_twin = [&](const Vec3& mass) {
    return std::any_of(robot.masses.begin(), robot.masses.end(), [&](const Vec3& other) {
      return length(other - Vec3{mass.x, -mass.y, mass.z}) < 1e-4f;
    });
  };
  EXPECT_TRUE(std::all_of(robot.masses.begin(), robot.masses.end(), has_twin));
}

TEST(NnRobot, APopulationDiffersInShapeAndMaterials) {
  std::vector<double> flatness, slenderness;  // shortest and middle extent by the longest
  double fewest = 23, sum = 0;
  for (const Robot& robot : random_nn_robots({}, 1, 64)) {
    std::array<float, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto coordinate = [&](const Vec3& x) { return axis == 0 ? x.x : axis == 1 ? x.y : x.z; };
      float low = 1, high = -1;
      for (const Vec3& x : robot.masses) low = std::min(low, coordinate(x)), high = std::max(high, coordinate(x));
      extent[axis] = high - low;
    }
    std::sort(extent.begin(), extent.end());
    flatness.push_back(extent[0] / extent[2]);
    slenderness.push_back(extent[1] / extent[2]);
    std::set<MaterialId> base;
    for (const Spring& s : robot.springs) {
      const auto [i, j] = base_materials_of(s.material);
      base.insert(i);
      base.insert(j);
    }
    fewest = std::min(fewest, static_cast<double>(base.size()));
    sum += static_cast<double>(base.size()) / 64;
  }
  const auto quantile = [](std::vector<double> values, std::size_t of_64) {
    std::sort(values.begin(), values.end());
    return values[of_64];
  };
  // A population of one shape has all at one value.
  EXPECT_LT(quantile(flatness, 8), 0.7 * quantile(flatness, 56));
  EXPECT_LT(quantile(slenderness, 8), 0.7 * quantile(slenderness, 56));
  EXPECT_GE(fewest, 2);
  EXPECT_GE(sum, 4);
}

TEST(NnRobot, MutantsAndChildrenOfRobotsGrow) {
  const NnGenome a = random_nn_genome({.points = 100}, 11), b = random_nn_genome({.points = 100}, 12);
  const NnGenome mutant = mutate(a, 0.1, 0.1, 13);
  EXPECT_EQ(mutant.network, mutate(a.network, 0.1, 0.1, 13));
  EXPECT_EQ(mutant.cloud_seed, a.cloud_seed);
  const Robot mutated = grow(mutant);
  check_body(mutated);
  EXPECT_NE(mutated.masses, grow(a).masses);
  EXPECT_EQ(*nn_genome_of(mutated), mutant);
  const NnGenome child = crossover(a, b, 14);
  EXPECT_EQ(child.network, crossover(a.network, b.network, 14));
  check_body(grow(child));
}

}  // namespace
}  // namespace mercury
