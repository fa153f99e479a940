// SPDX-License-Identifier: Apache-2.0
// What must hold for every robot grown by a network, and networks so simple that their bodies are known.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "mercury/nn_robot.h"
#include "tests/robots/surface.h"

namespace mercury {

// Number of edges with more than two faces; every edge must have as many faces one way as the other.
inline int check_closed_and_oriented(const Robot& robot) {
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

// Checks everything that holds for such a body. Returns the number of its edges with more than two faces.
inline int check_body(const Robot& robot) {
  EXPECT_NO_THROW(validate(robot));
  EXPECT_GE(robot.faces.size(), 4u);
  EXPECT_GT(enclosed_volume(robot), 0);
  EXPECT_EQ(spring_components(robot), 1u);
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
inline NnGenome simple_genome(const std::vector<std::vector<float>>& of_positive,
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

// For its two matrices.
inline const std::vector<std::vector<float>> identity = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline const std::vector<std::vector<float>> minus_identity = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
inline const std::vector<std::vector<float>> nothing = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

}  // namespace mercury
