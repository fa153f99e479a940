// SPDX-License-Identifier: Apache-2.0
// Real bodies against the theory of elasticity: the static equilibrium of bars by linear algebra, independent of the
// solvers.
#include "mercury/real_body.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mercury/cuda_devices.h"
#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/origin.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "mercury/simulation.h"
#include "mercury/voxel.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

Robot bar(int long_side, int side, float edge, MaterialId material = tissue) {
  VoxelGrid grid(long_side, side, side, material);
  grid.edge = edge;
  return make_voxel_robot(grid);
}

double total_mass(const Robot& robot) {
  double sum = 0;
  for (const float m : robot.mass) sum += m;
  return sum;
}

// The displacements of all masses under these forces, for small ones: K u = f, with a little stiffness against rigid
// motion, which balanced forces do not excite.
Eigen::VectorXd equilibrium(const Robot& robot, const Eigen::VectorXd& force) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto n = static_cast<int>(3 * robot.masses.size());
  for (const Spring& spring : robot.springs) {
    const Vec3 d = robot.masses[spring.b] - robot.masses[spring.a];
    const Eigen::Vector3d along = Eigen::Vector3d(d.x, d.y, d.z).normalized();
    const Eigen::Matrix3d k = robot.materials[spring.material].stiffness * along * along.transpose();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = 3 * spring.a, b = 3 * spring.b;
        entries.emplace_back(a + i, a + j, k(i, j));
        entries.emplace_back(b + i, b + j, k(i, j));
        entries.emplace_back(a + i, b + j, -k(i, j));
        entries.emplace_back(b + i, a + j, -k(i, j));
      }
  }
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1e-3);
  Eigen::SparseMatrix<double> stiffness(n, n);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(stiffness).solve(force);
}

struct Pulled {
  double modulus, poisson;
};

// Pulls a bar along x by a stress at both ends, an equal share of a voxel's side at each of its corners.
Pulled pull(const Robot& robot, int side, double edge) {
  const double stress = 10;  // [Pa]
  double low = 1e9, high = -1e9;
  for (const Vec3 x : robot.masses) {
    low = std::min(low, double{x.x});
    high = std::max(high, double{x.x});
  }
  Eigen::VectorXd force = Eigen::VectorXd::Zero(static_cast<int>(3 * robot.masses.size()));
  const auto sides_at = [&](double y) { return std::abs(std::abs(y) - side * edge / 2) < edge / 4 ? 1.0 : 2.0; };
  for (std::size_t i = 0; i < robot.masses.size(); ++i) {
    const Vec3 x = robot.masses[i];
    const double share = stress * edge * edge / 4 * sides_at(x.y) * sides_at(x.z);
    if (x.x < low + edge / 4) force[static_cast<int>(3 * i)] = -share;
    if (x.x > high - edge / 4) force[static_cast<int>(3 * i)] = share;
  }
  const Eigen::VectorXd u = equilibrium(robot, force);
  // Mean stretch between the ends, and mean narrowing in the middle.
  double ends = 0, across = 0;
  int at_ends = 0, at_sides = 0;
  for (std::size_t i = 0; i < robot.masses.size(); ++i) {
    const Vec3 x = robot.masses[i];
    const int row = static_cast<int>(3 * i);
    if (x.x > high - edge / 4) ends += u[row], ++at_ends;
    if (x.x < low + edge / 4) ends -= u[row];
    if (x.y > side * edge / 2 - edge / 4) across += u[row + 1], ++at_sides;
    if (x.y < -side * edge / 2 + edge / 4) across -= u[row + 1];
  }
  const double strain = ends / at_ends / (high - low);
  return {stress / strain, -across / at_sides / (side * edge) / strain};
}

TEST(RealBody, ABarHasTheModulusThatTheUserSaysAtEveryResolution) {
  for (const int side : {1, 2, 4, 8}) {
    const double edge = 0.2 / side;
    const Robot real = with_real_body(bar(3 * side, side, static_cast<float>(edge), 1), {.modulus = 2e5f});
    const Pulled found = pull(real, side, edge);
    EXPECT_NEAR(found.modulus / 2e5, 1, 0.03) << side;
    EXPECT_NEAR(found.poisson, 0.25, 0.01) << side;
  }
}

TEST(RealBody, TissueAndBoneAreAsStiffBesideMuscleAsInThePaper) {
  for (const auto& [material, ratio] : {std::pair{tissue, 0.8}, std::pair{bone, 2.0}}) {
    const Robot real = with_real_body(bar(4, 2, 0.1f, material), {.modulus = 1e5f});
    EXPECT_NEAR(pull(real, 2, 0.1).modulus / 1e5, ratio, 0.03) << int{material};
  }
}

TEST(RealBody, ItsMassIsThatOfItsVolumeAtEveryResolution) {
  for (const int side : {1, 2, 4}) {
    const Robot real = with_real_body(bar(4 * side, side, 0.2f / static_cast<float>(side)), {.density = 1100});
    EXPECT_NEAR(total_mass(real), 1100 * 0.8 * 0.2 * 0.2, 1e-3);
    EXPECT_NEAR(skin_volume(real), 0.8 * 0.2 * 0.2, 1e-6);
  }
}

TEST(RealBody, VoxelsOfTwoMaterialsGiveEachItsOwnSpring) {
  VoxelGrid grid(2, 1, 1, 1);
  grid.cell(1, 0, 0) = bone;
  const Robot paper = make_voxel_robot(grid), real = with_real_body(paper, {.modulus = 1e5f});
  // The side between them has 6 pairs of masses, which both voxels join.
  EXPECT_EQ(paper.springs.size(), 50u);
  EXPECT_EQ(real.springs.size(), 56u);
  for (const Spring& spring : real.springs) {
    const Material& own = real.materials[spring.material];
    const bool is_muscle = own.amplitude != 0;
    const double length = spring.rest_length / 0.1, modulus = is_muscle ? 1e5 : 2e5;
    const double share = std::abs(length - std::sqrt(2)) < 0.01 ? 0.10 : 0.15;
    EXPECT_NEAR(own.stiffness, share * modulus * 0.1, 1e-2 * own.stiffness);
    EXPECT_EQ(own.frequency, is_muscle ? default_materials()[1].frequency : 0);
  }
}

TEST(RealBody, SealedCavitiesHaveNoFaces) {
  VoxelGrid hollow(3, 3, 3, tissue);
  hollow.cell(1, 1, 1) = air;
  const Robot paper = make_voxel_robot(hollow), real = with_real_body(paper, {});
  EXPECT_EQ(paper.faces.size(), 12u * 9 + 12);
  EXPECT_EQ(real.faces.size(), 12u * 9);
  // Water is displaced by the cavity, too; it has no mass.
  EXPECT_NEAR(skin_volume(real), 27e-3, 1e-6);
  EXPECT_NEAR(total_mass(real), 1070 * 26e-3, 1e-3);
}

TEST(RealBody, AnyOtherNetworkHasTheModulusOnAverageAndTheMassOfItsVolume) {
  const Robot paper = find_generator("shell")->make({}, "", 3, 0);
  const Robot real = with_real_body(paper, {.modulus = 3e5f, .density = 900});
  std::vector<float> muscles;
  for (const Spring& spring : paper.springs)
    if (const Material& own = materials_of(paper)[spring.material]; own.amplitude != 0)
      muscles.push_back(own.stiffness);
  std::ranges::sort(muscles);
  double sum = 0;  // of k L0^2, as if all were such muscles
  for (const Spring& spring : real.springs)
    sum += real.materials[spring.material].stiffness * double{muscles[muscles.size() / 2]} /
           materials_of(paper)[spring.material].stiffness * spring.rest_length * spring.rest_length;
  EXPECT_NEAR(sum / (6 * skin_volume(real)) / 3e5, 1, 1e-3);
  EXPECT_NEAR(total_mass(real), 900 * skin_volume(real), 1e-3 * total_mass(real));
}

TEST(RealBody, TheOriginSaysWhatTheBodyIsOfAndChildrenAreOfTheSame) {
  const RealMaterial material{.modulus = 5e4f, .density = 1000, .relaxation_time = 0.02f};
  for (const Generator& generator : generators()) {
    SCOPED_TRACE(generator.kind);
    ParameterValues values{{"physics", std::string("real")},
                           {"modulus", material.modulus},
                           {"body_density", material.density},
                           {"relaxation_time", material.relaxation_time}};
    const Robot parent = generator.make(values, "", 1, 0);
    EXPECT_EQ(real_material_of(parent), material);
    EXPECT_FALSE(parent.mass.empty());
    const Robot paper = generator.make({}, "", 1, 0);
    EXPECT_EQ(with_real_body(paper, material), parent);
    EXPECT_EQ(real_material_of(paper), std::nullopt);
    EXPECT_EQ(generator.regrow(parent), parent);
    const Robot child = generator.mutate(parent, {.strength = 1, .seed = 5}, "child");
    EXPECT_EQ(real_material_of(child), material);
    validate(child);
    if (generator.cross) {
      EXPECT_EQ(real_material_of(generator.cross(parent, child, 2, "cross")), material);
    }
  }
}

// A bar of two halves, one above the other: pulled to the same strain, it carries the mean of their moduli.
TEST(RealBody, MaterialsThatSayWhatTheyAreMadeOf) {
  VoxelGrid grid(12, 4, 4, 1);
  grid.edge = 0.05f;
  for (int x = 0; x < 12; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 2; z < 4; ++z) grid.cell(x, y, z) = 2;
  const Robot paper = make_voxel_robot(grid);
  RealMaterial material{.modulus = 1e5f};
  material.each.resize(default_materials().size());
  material.each[1] = {1e5f, 900, 0.02f};
  material.each[2] = {5e5f, 1500, 0};
  const Robot real = with_real_body(paper, material);
  EXPECT_NEAR(total_mass(real), 0.5 * (900 + 1500) * 0.6 * 0.2 * 0.2, 1e-3);
  for (const Spring& spring : real.springs) {
    const Material& own = real.materials[spring.material];
    EXPECT_EQ(own.relaxation_time, own.phase == default_materials()[1].phase ? 0.02f : 0.0f);
  }
  EXPECT_EQ(real_material_of(real)->each, material.each);
  EXPECT_EQ(physics_of(real), Physics::real);
  // One material alone.
  for (const auto& [id, modulus] : {std::pair{MaterialId{1}, 1e5}, {MaterialId{2}, 5e5}})
    EXPECT_NEAR(pull(with_real_body(bar(12, 4, 0.05f, id), material), 4, 0.05).modulus / modulus, 1, 0.03);
}

// A file whose table says of what the materials are made is the body that with_real_body() makes of it.
TEST(RealBody, AFileMayGiveModuli) {
  VoxelGrid grid(4, 2, 1, 1);
  grid.cell(3, 0, 0) = grid.cell(3, 1, 0) = 2;
  Robot paper = make_voxel_robot(grid);
  for (Spring& spring : paper.springs)  // those of both have a third material among the 254
    if (spring.material > 2) spring.material = 1;
  paper.materials = {{}, {50, 0.2f, 6, 1}, {100}};
  paper.material_names = {"air", "muscle", "fin"};
  paper.actuators = {{"body", {1}}, {"of no voxel", {3}}};
  paper.materials.push_back({50, 0.2f, 6, 2});
  paper.material_names.push_back("spare");
  const Robot without = with_real_body(paper, {});
  EXPECT_EQ(without.actuators.size(), 1u);
  EXPECT_NO_THROW(validate(without));
  paper.actuators.pop_back();
  paper.materials.pop_back();
  paper.material_names.pop_back();
  std::string text = serialize_robot(paper, RobotFormat::json);
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from << text.substr(0, 800);
    text.replace(at, from.size(), to);
  };
  replace("\"stiffness\":50", "\"modulus\":2e5,\"density\":1000,\"relaxation_time\":0.02");
  replace("\"stiffness\":100", "\"modulus\":4e5,\"density\":1200,\"relaxation_time\":0.01");
  Robot found = parse_robot(text, RobotFormat::json);
  const Robot real = with_real_body(paper, {2e5f, 1000, 0.02f, {{}, {2e5f, 1000, 0.02f}, {4e5f, 1200, 0.01f}}});
  EXPECT_EQ(found, real);
  ASSERT_EQ(real.actuators.size(), 1u);
  // All materials that muscles became, and no other.
  for (std::size_t id = 1; id < real.materials.size(); ++id) {
    const auto& own = real.actuators[0].materials;
    EXPECT_EQ(std::ranges::find(own, id) != own.end(), real.materials[id].amplitude != 0) << id;
  }
  EXPECT_EQ(parse_robot(serialize_robot(found, RobotFormat::json), RobotFormat::json), found);
}

TEST(RealBody, AFileOfModuliThatBreaksARuleIsRefused) {
  const std::string text = serialize_robot(make_voxel_robot(VoxelGrid(2, 1, 1, 1)), RobotFormat::json);
  const auto refusal = [&](const std::string& materials, const std::string& rest = "") -> std::string {
    std::string changed = text;
    changed.insert(changed.find("\"masses\""), rest + "\"materials\":[{\"stiffness\":0}," + materials + "],");
    return mercury::refusal([&] { parse_robot(changed, RobotFormat::json); });
  };
  EXPECT_EQ(refusal(R"({"modulus":1e5,"density":1000})"), "");
  EXPECT_EQ(refusal(R"({"modulus":1e5})"), "/materials/1: modulus and density come together; give both or neither");
  EXPECT_EQ(refusal(R"({"stiffness":5,"density":1000})"),
            "/materials/1: modulus and density come together; give both or neither");
  EXPECT_EQ(refusal(R"({"stiffness":5,"modulus":1e5,"density":1000})"),
            "/materials/1: a stiffness follows from the modulus; give one of them");
  EXPECT_EQ(refusal(R"({"modulus":0,"density":1000})"), "/materials/1: modulus and density must be above 0");
  EXPECT_EQ(refusal(R"({"modulus":1e5,"density":-1})"), "/materials/1: modulus and density must be above 0");
  EXPECT_EQ(refusal(R"({"modulus":1e5,"density":1000},{"stiffness":5})"),
            "/materials/2: has a stiffness beside materials with a modulus; give it one, and a density");
  EXPECT_EQ(refusal(R"({"modulus":1e5,"density":1000})", R"("mass":[1,1,1,1,1,1,1,1,1,1,1,1],)"),
            "/mass: follows from the density of the materials; leave it out");
  EXPECT_EQ(refusal(R"({"modulus":1e5,"density":1000})", R"("actuators":[{"name":"a","springs":[0]}],)"),
            "/actuators/0/springs: springs follow from the moduli of materials; name materials");
}

// Among them three whose contacts a GPU once found otherwise.
TEST(RealBody, RandomBodiesMoveOnCudaAsOnTheCpu) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  std::vector<Robot> robots;
  for (std::uint64_t i = 0; i < 200; ++i) robots.push_back(with_real_body(random_voxel_robot({}, 1, i), {}));
  for (const std::uint64_t i : {165, 1396, 2544}) robots.push_back(with_real_body(random_voxel_robot({}, 1, i), {}));
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Configuration configuration{.solver = solver, .environment = environment_named("water")};
    configuration.device.kind = DeviceKind::cpu;
    Simulation cpu(configuration, robots);
    configuration.device.kind = DeviceKind::cuda;
    Simulation cuda(configuration, robots);
    for (Simulation* simulation : {&cpu, &cuda}) simulation->step(100);
    for (std::size_t robot = 0; robot < robots.size(); ++robot) {
      const auto expected = cpu.positions(robot), actual = cuda.positions(robot);
      float farthest = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) farthest = std::max(farthest, length(expected[i] - actual[i]));
      EXPECT_LT(farthest, 1e-5f) << name_of(solver) << ", robot " << robot;
    }
  }
}

TEST(RealBody, ErrorsSayWhatIsMissing) {
  const Robot real = with_real_body(bar(2, 1, 0.1f), {});
  EXPECT_THROW(with_real_body(real, {}), InputError);
  EXPECT_THROW(with_real_body(bar(2, 1, 0.1f), {.modulus = -1}), ParameterError);
  Robot open = find_generator("shell")->make({}, "", 3, 0);
  open.faces.clear();
  EXPECT_THROW(with_real_body(open, {}), InputError);
  Robot damaged = real;
  damaged.origin = R"({"real":{"modulus":"soft","density":1000,"relaxation_time":0}})";
  EXPECT_THROW(real_material_of(damaged), InputError);
}

}  // namespace
}  // namespace mercury
