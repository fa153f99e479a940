// SPDX-License-Identifier: Apache-2.0
// Bars of imported voxels against the beams of Voxelyze that they stand for: small vibrations, from the stiffness
// matrix of their springs, and masses.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "robots/importers/calibration.h"
#include "robots/importers/voxel_body.h"
#include "tests/robots/importers/documents.h"

namespace mercury {
namespace {

using std::numbers::pi;

// Voxels of n x n x length, all alike, of a size that is almost 1, so that the bar has a table of its own. The
// stiffness of a beam over the mass of a voxel is 1/s2.
Robot bar(int n, int length, SpringRule rule) {
  const VoxelBody body{.nx = n,
                       .ny = n,
                       .nz = length,
                       .cells = std::vector<std::uint32_t>(static_cast<std::size_t>(n * n * length), 1),
                       .substances = {{.stiffness = 1 / slice_stiffness(BeamModel{}.thickness), .size = 1 + 1e-12}},
                       .names = {"tissue"},
                       .held = {}};
  Rounding rounding;
  return voxel_body_robot(body, "bar", {}, 255, rounding, rule);
}

// A vibration of a free body: its frequency [rad/s], and where the masses go.
struct Vibration {
  double frequency = 0;
  Eigen::VectorXd shape;
};

// All of them, slowest first: 6 motions of the whole body come before the vibrations.
std::vector<Vibration> vibrations_of(const Robot& robot) {
  const auto size = static_cast<Eigen::Index>(3 * robot.masses.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  const auto at = [&](std::size_t mass) {
    return Eigen::Vector3d(robot.masses[mass].x, robot.masses[mass].y, robot.masses[mass].z);
  };
  const auto inertia = [&](std::size_t mass) { return std::sqrt(static_cast<double>(mass_of(robot, mass))); };
  for (const Spring& spring : robot.springs) {
    const Eigen::Vector3d n = (at(spring.b) - at(spring.a)).normalized();
    const Eigen::Matrix3d k = static_cast<double>(robot.materials[spring.material].stiffness) * n * n.transpose();
    for (const std::size_t i : {spring.a, spring.b})
      for (const std::size_t j : {spring.a, spring.b})
        matrix.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j)) +=
            (i == j ? 1 : -1) * k / (inertia(i) * inertia(j));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  std::vector<Vibration> vibrations;
  for (Eigen::Index i = 0; i < size; ++i) {
    Eigen::VectorXd shape = solver.eigenvectors().col(i);
    for (std::size_t mass = 0; mass < robot.masses.size(); ++mass)
      shape.segment<3>(3 * static_cast<Eigen::Index>(mass)) /= inertia(mass);
    vibrations.push_back({std::sqrt(std::max(solver.eigenvalues()(i), 0.0)), shape});
  }
  return vibrations;
}

// The slowest vibration that moves masses mostly as `direction(mass)` says, up to a factor per layer.
template <class Direction>
double slowest(const Robot& robot, const Direction& direction) {
  const std::vector<Vibration> vibrations = vibrations_of(robot);
  for (std::size_t i = 6; i < vibrations.size(); ++i) {
    double along = 0, all = 0;
    for (std::size_t mass = 0; mass < robot.masses.size(); ++mass) {
      const Eigen::Vector3d moved = vibrations[i].shape.segment<3>(3 * static_cast<Eigen::Index>(mass));
      along += std::pow(moved.dot(direction(robot.masses[mass]).normalized()), 2);
      all += moved.squaredNorm();
    }
    if (along > 0.9 * all) return vibrations[i].frequency;
  }
  return 0;
}

// A bar of beams is a chain: omega = pi / N for long ones. One voxel across as well as three.
TEST(BeamBody, BarsOfAllThicknessesStretchAsTheirBeams) {
  constexpr int length = 20;
  for (const int n : {1, 2, 3}) {
    const double found = slowest(bar(n, length, SpringRule::stretching), [](Vec3) { return Eigen::Vector3d(0, 0, 1); });
    EXPECT_NEAR(found / (pi / length), 1, 0.02) << n;
  }
}

// omega = (4.730 / L)^2 sqrt(E I / (rho A)), with I / A = (n edge)^2 / 12 for a square cross-section (Timoshenko,
// Vibration Problems in Engineering, 1937). Shear and the inertia of turning lower it by (4.73 r / L)^2 (1 + E / G) / 2
// in first order, r^2 = I / A and E / G = 2.5; corners turn as if r^2 were n^2 / 12 + 1 / 6.
TEST(BeamBody, LimbsBendAsTheirBeams) {
  for (const auto& [n, length] : {std::pair(1, 20), std::pair(2, 24), std::pair(3, 24)}) {
    // Diagonal directions, so that neither of two equal vibrations is a mixture.
    const Robot robot = bar(n, length, SpringRule::bending);
    const double found = vibrations_of(robot)[6].frequency;
    const double slenderness = std::pow(4.730 / length, 2);
    const double thin = slenderness * std::sqrt(n * n / 12.0);
    const double lowered = slenderness * (n * n / 12.0 * 3.5 + 1.0 / 6) / 2;
    EXPECT_NEAR(found / (thin * (1 - lowered)), 1, 0.03) << n;
  }
}

// Without that, springs at the surface of voxels make a limb n voxels thick stiffer by 1 + 1.4 / n^2.
TEST(BeamBody, StretchingBodiesBendMoreStiffly) {
  for (const int n : {1, 2}) {
    const double stiff = vibrations_of(bar(n, 24, SpringRule::stretching))[6].frequency;
    const double soft = vibrations_of(bar(n, 24, SpringRule::bending))[6].frequency;
    EXPECT_NEAR(std::pow(stiff / soft, 2), 1 + 1.4 / (n * n), 0.01) << n;
  }
}

// A beam's torsion is G J / L = k edge^2 / (12 (1 + nu)), k edge^2 / 15 for nu = 1/4. The corners of a voxel have the
// moment of inertia m edge^2 / 2.
TEST(BeamBody, ABarOfOneVoxelTwistsAsItsBeams) {
  constexpr int length = 20;
  const double found =
      slowest(bar(1, length, SpringRule::stretching), [](Vec3 at) { return Eigen::Vector3d(-at.y, at.x, 0); });
  EXPECT_NEAR(found / (pi / length * std::sqrt(2.0 / 15)), 1, 0.02);
}

TEST(BeamBody, EveryVoxelWeighsAsMuch) {
  for (const SpringRule rule : {SpringRule::stretching, SpringRule::standing})
    for (const int n : {1, 2, 3}) {
      const Robot robot = bar(n, 25, rule);
      double sum = 0;
      for (const float mass : robot.mass) sum += static_cast<double>(mass);
      EXPECT_DOUBLE_EQ(sum, n * n * 25) << n;
    }
}

// How far the upper end of an upright bar whose lowest voxels are held goes by 1 N along an axis [m].
double compliance(const Robot& robot, double held_edges, int axis) {
  float lowest = robot.masses[0].z, highest = lowest;
  for (const Vec3& at : robot.masses) {
    lowest = std::min(lowest, at.z);
    highest = std::max(highest, at.z);
  }
  const auto size = static_cast<Eigen::Index>(3 * robot.masses.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  const auto at = [&](std::size_t mass) {
    return Eigen::Vector3d(robot.masses[mass].x, robot.masses[mass].y, robot.masses[mass].z);
  };
  for (const Spring& spring : robot.springs) {
    const Eigen::Vector3d n = (at(spring.b) - at(spring.a)).normalized();
    const Eigen::Matrix3d k = static_cast<double>(robot.materials[spring.material].stiffness) * n * n.transpose();
    for (const std::size_t i : {spring.a, spring.b})
      for (const std::size_t j : {spring.a, spring.b})
        matrix.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j)) += (i == j ? 1 : -1) * k;
  }
  Eigen::VectorXd force = Eigen::VectorXd::Zero(size);
  for (std::size_t mass = 0; mass < robot.masses.size(); ++mass) {
    const auto row = 3 * static_cast<Eigen::Index>(mass);
    if (robot.masses[mass].z > highest - 0.01f) force(row + axis) = 1;
    if (robot.masses[mass].z < lowest + static_cast<float>(held_edges * imported_edge) + 0.01f)
      matrix.diagonal().segment<3>(row).array() += 1e9;
  }
  force /= force.sum();
  return force.dot(Eigen::VectorXd(matrix.ldlt().solve(force)));
}

// By stretch, L / (n^2 k). By bending, L^3 / (3 E I) with E I = n^4 k / 12; the frame of more than one beam also
// shears, L / (G n^2) with G = k / 2. All in edges and for k = 1.
TEST(BeamBody, StandingBarsStretchAndBendAsTheirBeams) {
  for (const int n : {1, 2, 3})
    for (const int length : {4, 8}) {
      // One voxel more, which is held: its upper corners, its middle and that on which it stands.
      const Robot robot = bar(n, length + 1, SpringRule::standing);
      const double area = n * n, shear = n > 1 ? length / (0.5 * area) : 0;
      EXPECT_NEAR(compliance(robot, 0.5, 2) / (length / area), 1, 0.2) << n << " " << length;
      EXPECT_NEAR(compliance(robot, 0.5, 0) / (4 * std::pow(length, 3) / (area * area) + shear), 1, 0.2)
          << n << " " << length;
    }
}

// The middle of its lowest voxel, half an edge below the lowest corners.
TEST(BeamBody, AColumnStandsOnTheMiddleOfAVoxel) {
  const Robot robot = bar(1, 3, SpringRule::standing);
  EXPECT_EQ(robot.masses.size(), 3u * 4 + 3);
  std::vector<float> heights;
  for (const Vec3& at : robot.masses) heights.push_back(at.z);
  std::sort(heights.begin(), heights.end());
  EXPECT_NEAR(heights[0], -0.1, 1e-6);
  EXPECT_NEAR(heights[1], -0.05, 1e-6);
  EXPECT_NEAR(heights[4], -0.05, 1e-6);
}

// Every edge of a face belongs to one other face, which runs along it the other way.
TEST(BeamBody, SkinsOfStandingBodiesAreClosed) {
  // A table with one leg of one voxel and one of two, and a belly.
  const VoxelBody body{.nx = 4,
                       .ny = 2,
                       .nz = 2,
                       .cells = {1, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1},
                       .substances = {{.stiffness = 1, .size = 1 + 1e-12}},
                       .names = {"tissue"},
                       .held = {}};
  Rounding rounding;
  const Robot robot = voxel_body_robot(body, "table", {}, 255, rounding, SpringRule::standing);
  std::map<std::pair<int, int>, int> edges;
  for (const Face& face : robot.faces)
    for (const auto& [from, to] : {std::pair(face.a, face.b), std::pair(face.b, face.c), std::pair(face.c, face.a)}) {
      ++edges[{from, to}];
      --edges[{to, from}];
    }
  ASSERT_FALSE(edges.empty());
  for (const auto& [edge, sum] : edges) EXPECT_EQ(sum, 0) << edge.first << " " << edge.second;
}

TEST(BeamBody, HeldVoxelsOfStandingBodiesHoldTheirMiddles) {
  const VoxelBody body{.nx = 1,
                       .ny = 1,
                       .nz = 3,
                       .cells = {1, 1, 1},
                       .substances = {{.stiffness = 1, .size = 1 + 1e-12}},
                       .names = {"tissue"},
                       .held = {true, false, false}};
  Rounding rounding;
  Robot robot = voxel_body_robot(body, "post", {}, 255, rounding, SpringRule::standing);
  fix_masses(robot, body);
  EXPECT_EQ(robot.fixed.size(), 5u);  // four upper corners and the middle
  for (const std::uint16_t mass : robot.fixed) EXPECT_LT(robot.masses[mass].z, -0.04f);
}

VxaParts muscles(bool in_fluid) {
  VxaParts parts;
  parts.lattice = "<Lattice_Dim>0.1</Lattice_Dim>";
  parts.size = "<X_Voxels>40</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>";
  parts.data = "<Layer>" + std::string(40, '1') + "</Layer>";
  parts.layers = "<PhaseOffset><Layer>" + phases_along_x(40) + "</Layer></PhaseOffset>";
  if (in_fluid)
    parts.environment =
        "<FluidEnvironment>1</FluidEnvironment><AggregateDragCoefficient>750</AggregateDragCoefficient>";
  return parts;
}

TEST(BeamBody, WalkersStandOnTheirMiddlesAndSwimmersHaveNone) {
  const Import swimmer = import_of(muscles(true)), walker = import_of(muscles(false));
  ASSERT_EQ(swimmer.settings.environment, "resistive");
  ASSERT_EQ(walker.settings.environment, "land");
  EXPECT_EQ(swimmer.robots[0].masses.size(), 4u * 41);
  EXPECT_EQ(walker.robots[0].masses.size(), 2u * 41 + 40);
  EXPECT_EQ(swimmer.settings.contact_distance, 0.5);
  EXPECT_NEAR(walker.settings.contact_distance * std::sqrt(0.75), 0.615, 1e-6);  // in half space diagonals
  ImportedSettings touching = walker.settings;
  touching.self_collision = true;
  EXPECT_NE(to_toml(touching, walker.report).find("contact-distance = 0.71"), std::string::npos);
  // Density 1000 kg/m3 and 1 kg per voxel: C_N = 2 c / rho, of water that pushes outward faces alone.
  EXPECT_NEAR(swimmer.settings.drag_coefficient, 1.5, 1e-9);
  EXPECT_NE(to_toml(swimmer.settings, swimmer.report).find("one-sided = true"), std::string::npos);
}

// A beam pulls with k (|d| - L + tau d(|d| - L)/dt), a spring with k (|d| - L' + tau d|d|/dt): L' = L + tau dL/dt.
TEST(BeamBody, MusclesOfWalkersLeadByTheirDamping) {
  VxaParts parts = muscles(false);
  parts.simulator = "<Damping><BondDampingZ>1</BondDampingZ></Damping>";
  const Robot robot = import_of(parts).robots[0];
  const double tau = 0.1 * std::sqrt(1000 / 1e5), omega = 2 * pi / 0.5;
  double largest = 0;
  for (std::size_t id = 1; id < robot.materials.size(); ++id) {
    const Material& material = robot.materials[id];
    const double share = static_cast<double>(material.relaxation_time) / tau;
    EXPECT_NEAR(std::min({std::abs(share - 0.5), std::abs(share - 1), std::abs(share - 1.5)}), 0, 1e-5);
    // From the middle to the corners, of one voxel alone: 4/3 of its amplitude of 0.14.
    if (std::abs(share - 1) < 1e-5) largest = std::max(largest, static_cast<double>(material.amplitude));
  }
  EXPECT_NEAR(largest, 4.0 / 3 * 0.14 * std::hypot(1, omega * tau), 1e-6);
}

// Two robots whose points have other masses must have other numbers in the file, or its drag would change.
TEST(BeamBody, DragComesBackFromAFile) {
  const Import swimmer = import_of(muscles(true));
  const Import back = import_text(vxa_document(swimmer.robots[0], swimmer.settings), "vxa", "test");
  EXPECT_NEAR(back.settings.drag_coefficient, swimmer.settings.drag_coefficient, 1e-9);
  EXPECT_EQ(back.robots[0].mass, swimmer.robots[0].mass);
}

}  // namespace
}  // namespace mercury
