// SPDX-License-Identifier: Apache-2.0
// What robots do, as points in the space of some quantities, and the cells of a map in which these lie.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "mercury/algorithm.h"
#include "mercury/robot.h"

namespace mercury {

// One number per axis, 0 at its lowest value and 1 at its highest; beyond these outside.
using Behavior = std::vector<double>;

// None if the robot came to grief, or a quantity is not known: what it measured then means nothing.
std::optional<Behavior> behavior_of(std::span<const MapAxis> axes, const Individual& individual);

double squared_distance(std::span<const double> a, std::span<const double> b);

// The index of the nearest point, of equally near ones the first.
std::size_t nearest_of(std::span<const Behavior> points, std::span<const double> to);

// Cells of equal size: the points to which robots count if no other one is nearer. A centroidal Voronoi tessellation
// of the unit cube by Lloyd's algorithm on random samples (Vassiliades, Chatzilygeroudis and Mouret 2018, algorithm 1).
// Depends on the arguments alone.
std::vector<Behavior> centroids(std::size_t dimensions, std::size_t cells);

// The map of map-elites and CMA-ME: the best robot of each cell lives on.
class CellMap {
 public:
  explicit CellMap(const AlgorithmSettings& settings) : settings_(settings) {}

  // Of an individual that was measured.
  std::size_t cell_of(const Individual& individual) const;
  // Indices in the pool, the best first. Robots of the worst score get no cell, unless all have it: then those that are
  // nearest to being sound do. What an exploded robot measured means nothing, so of those only the first one lives on,
  // so that a run has always somebody.
  std::vector<std::size_t> elites(std::span<const Individual> pool) const;

 private:
  const AlgorithmSettings settings_;
  mutable std::once_flag centers_made_;
  mutable std::vector<Behavior> centers_;
};

// Measures of a body at rest.

// Sides of the axis-parallel box around the masses [m]; 0 without masses.
Vec3 box_of(const Robot& robot);

// Volume that the skin encloses [m3], by the divergence theorem; 0 without faces.
double volume_of(const Robot& robot);

// How well the body equals its mirror image in y, 0..1. The mirror is the middle of the body's box. Each mass counts
// 1 - d/r, at least 0, where d is the distance from its mirror image to the nearest mass and r is half the mean rest
// length of the springs: 1 for a symmetric body, and for a lattice the share of its masses that have a partner.
double mirror_symmetry(const Robot& robot);

}  // namespace mercury
