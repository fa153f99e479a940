// SPDX-License-Identifier: Apache-2.0
// Substances in as few groups as a table of materials holds.
//
// A spring of stiffness k and rest length L pulls with k L (strain - movement). So the error of a rounded substance,
// over k L, is its distance from the exact one in these coordinates [1]:
//
//   A log k                     a relative error of the stiffness, at a strain as large as the largest movement A
//   Re, Im of the movement      amplitude and phase at once: phases count where amplitudes are large
//   2 pi A log frequency        the error of the phase after a period
//   size                        of the rest length itself
//
// Groups keep the sum of its squares over all springs small:
//
// 1. All are in one group. The group with the largest sum is divided at its mean, along the coordinate that contributes
//    most, until there are as many groups as may be.
// 2. Each substance goes to the group whose mean is nearest, and means are computed again, a few times (Lloyd 1982).
//
// Muscles and what does not move, half waves and relaxation times stay apart, by a coordinate whose steps are far
// larger than all else.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <unordered_map>
#include <utility>

#include "mercury/fnv.h"
#include "robots/importers/substances.h"

namespace mercury {
namespace {

using ExactKey = std::array<std::int64_t, 7>;

struct ExactKeyHash {
  std::size_t operator()(const ExactKey& key) const {
    Fnv1a hash;
    for (const std::int64_t part : key) hash.step(static_cast<std::uint64_t>(part));
    return static_cast<std::size_t>(hash.value() ^ hash.value() >> 32);
  }
};

std::int64_t float_bits(double value) {
  return static_cast<std::int64_t>(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

double log_of(double value) { return std::log(std::max(value, 1e-30)); }

// `key_of`: of the index of a substance. Groups are in the order in which substances come.
template <class Hash, class KeyOf>
SubstanceGroups groups_by(std::span<const Substance> substances, const KeyOf& key_of) {
  SubstanceGroups found;
  std::unordered_map<decltype(key_of(0)), std::size_t, Hash> known;
  std::vector<std::vector<Substance>> members;
  for (std::size_t i = 0; i < substances.size(); ++i) {
    const auto [place, is_new] = known.try_emplace(key_of(i), members.size());
    if (is_new) members.emplace_back();
    members[place->second].push_back(substances[i]);
    found.group_of.push_back(place->second);
  }
  for (const std::vector<Substance>& group : members) found.substances.push_back(mean_substance(group));
  return found;
}

// Those that become the same material are in one group.
SubstanceGroups exact_groups(std::span<const Substance> substances) {
  return groups_by<ExactKeyHash>(substances, [&](std::size_t i) {
    const Substance& substance = substances[i];
    const Material material = material_of(substance);
    return ExactKey{float_bits(material.stiffness),
                    float_bits(material.amplitude),
                    float_bits(material.frequency),
                    float_bits(material.phase),
                    substance.half_wave,
                    float_bits(substance.size),
                    float_bits(material.relaxation_time)};
  });
}

constexpr std::size_t dimensions = 6;
using Point = std::array<double, dimensions>;

struct WeightedPoint {
  Point at;
  double weight = 0;  // springs
};

std::vector<WeightedPoint> points_of(const SubstanceGroups& exact) {
  constexpr double far_apart = 1e3;
  double largest = 0, frequencies = 0, muscles = 0;
  for (const Substance& substance : exact.substances) {
    largest = std::max(largest, std::abs(substance.amplitude));
    if (!moves(substance)) continue;
    frequencies += log_of(substance.frequency);
    ++muscles;
  }
  const double scale = largest > 0 ? largest : 1;
  std::map<std::pair<int, std::int64_t>, double> kinds;
  std::vector<WeightedPoint> points;
  for (const Substance& substance : exact.substances) {
    const std::complex<double> movement = movement_of(substance);
    // The half in which a half wave acts changes with the sign of its amplitude.
    const int wave = !moves(substance) ? 0 : !substance.half_wave ? 1 : substance.amplitude < 0 ? 2 : 3;
    const double kind =
        kinds.try_emplace({wave, float_bits(substance.relaxation_time)}, static_cast<double>(kinds.size()))
            .first->second;
    const double log_frequency = moves(substance) ? log_of(substance.frequency) : frequencies / std::max(muscles, 1.0);
    points.push_back({.at = {scale * log_of(substance.stiffness), movement.real(), movement.imag(),
                             turn * scale * log_frequency, substance.size, far_apart * kind}});
  }
  for (const std::size_t group : exact.group_of) ++points[group].weight;
  return points;
}

class Clusters {
 public:
  // At most `most` clusters.
  Clusters(const std::vector<WeightedPoint>& points, std::size_t most) : points_(points), cluster_of_(points.size()) {
    divide(most);
    improve();
  }
  const std::vector<std::size_t>& cluster_of() const { return cluster_of_; }  // of each point

 private:
  struct Cluster {
    std::vector<std::size_t> members;
    double squares = 0;    // sum of squared distances from the mean
    std::size_t axis = 0;  // that contributes most
    Point mean{};
  };

  Point mean_of(const std::vector<std::size_t>& members) const {
    Point mean{};
    double weight = 0;
    for (const std::size_t i : members) {
      weight += points_[i].weight;
      for (std::size_t d = 0; d < dimensions; ++d) mean[d] += points_[i].weight * points_[i].at[d];
    }
    for (double& value : mean) value /= weight;
    return mean;
  }

  Cluster cluster_with(std::vector<std::size_t> members) const {
    Cluster cluster{.members = std::move(members)};
    cluster.mean = mean_of(cluster.members);
    Point squares{};
    for (const std::size_t i : cluster.members)
      for (std::size_t d = 0; d < dimensions; ++d) {
        const double apart = points_[i].at[d] - cluster.mean[d];
        squares[d] += points_[i].weight * apart * apart;
      }
    cluster.axis = static_cast<std::size_t>(std::ranges::max_element(squares) - squares.begin());
    for (const double square : squares) cluster.squares += square;
    return cluster;
  }

  void divide(std::size_t most) {
    std::vector<std::size_t> all(points_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    clusters_.push_back(cluster_with(std::move(all)));
    while (clusters_.size() < most) {
      Cluster& largest = *std::ranges::max_element(clusters_, {}, &Cluster::squares);
      std::vector<std::size_t> below, above;
      for (const std::size_t i : largest.members)
        (points_[i].at[largest.axis] < largest.mean[largest.axis] ? below : above).push_back(i);
      if (below.empty() || above.empty()) break;  // all squares are rounding
      largest = cluster_with(std::move(below));
      clusters_.push_back(cluster_with(std::move(above)));
    }
    for (std::size_t c = 0; c < clusters_.size(); ++c)
      for (const std::size_t i : clusters_[c].members) cluster_of_[i] = c;
  }

  void improve() {
    constexpr double most_distances = 2e8;  // about a second
    const double distances = static_cast<double>(points_.size()) * static_cast<double>(clusters_.size());
    const int rounds = static_cast<int>(std::min(30.0, most_distances / distances));
    for (int round = 0; round < rounds; ++round) {
      bool changed = false;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const std::size_t nearest = nearest_to(points_[i].at, cluster_of_[i]);
        changed = changed || nearest != cluster_of_[i];
        cluster_of_[i] = nearest;
      }
      if (!changed) return;
      for (Cluster& cluster : clusters_) cluster.members.clear();
      for (std::size_t i = 0; i < points_.size(); ++i) clusters_[cluster_of_[i]].members.push_back(i);
      for (Cluster& cluster : clusters_)
        if (!cluster.members.empty()) cluster.mean = mean_of(cluster.members);
    }
  }

  std::size_t nearest_to(const Point& point, std::size_t current) const {
    std::size_t nearest = current;
    double least = squared_distance(point, clusters_[current].mean);
    for (std::size_t c = 0; c < clusters_.size(); ++c)
      if (const double squared = squared_distance(point, clusters_[c].mean); squared < least) {
        least = squared;
        nearest = c;
      }
    return nearest;
  }
  static double squared_distance(const Point& a, const Point& b) {
    double sum = 0;
    for (std::size_t d = 0; d < dimensions; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
    return sum;
  }

  const std::vector<WeightedPoint>& points_;
  std::vector<std::size_t> cluster_of_;
  std::vector<Cluster> clusters_;
};

void measure(std::span<const Substance> substances, SubstanceGroups& found) {
  Rounding& rounding = found.rounding;
  const auto raise = [](double& most, double value) { most = std::max(most, std::abs(value)); };
  for (std::size_t i = 0; i < substances.size(); ++i) {
    const Substance &exact = substances[i], &used = found.substances[found.group_of[i]];
    raise(rounding.stiffness, used.stiffness / std::max(exact.stiffness, 1e-30) - 1);
    raise(rounding.amplitude, std::abs(used.amplitude) - std::abs(exact.amplitude));
    if (!moves(exact) || !moves(used)) continue;
    raise(rounding.phase, std::arg(movement_of(used) * std::conj(movement_of(exact))));
    raise(rounding.frequency, used.frequency / exact.frequency - 1);
  }
}

SubstanceGroups rounded_groups(std::span<const Substance> substances, const SubstanceGroups& exact, std::size_t most) {
  const std::vector<WeightedPoint> points = points_of(exact);
  const std::vector<std::size_t> cluster_of = Clusters(points, most).cluster_of();
  SubstanceGroups found =
      groups_by<std::hash<std::size_t>>(substances, [&](std::size_t i) { return cluster_of[exact.group_of[i]]; });
  measure(substances, found);
  return found;
}

}  // namespace

SubstanceGroups grouped(std::span<const Substance> substances, std::size_t most) {
  SubstanceGroups found = exact_groups(substances);
  const std::size_t distinct = found.substances.size();
  if (distinct > most) found = rounded_groups(substances, found, most);
  found.rounding.substances = distinct;
  found.rounding.groups = found.substances.size();
  return found;
}

}  // namespace mercury
