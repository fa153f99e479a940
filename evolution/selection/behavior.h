// SPDX-License-Identifier: Apache-2.0
// What robots do, as points in the space of some quantities.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mercury/algorithm.h"

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

}  // namespace mercury
