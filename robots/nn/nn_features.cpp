// SPDX-License-Identifier: Apache-2.0
#include "robots/nn/nn_features.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace mercury {
namespace {

constexpr double ball_radius = 1.7;  // of what gather() leaves of a normal cloud

}  // namespace

Vector direction(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return unit({x, y, z});
}

Vector direction_across(const Vector& axis, Random& random) {
  const Vector d = direction(random);
  return unit(d + -dot(d, axis) * axis);
}

void gather(Features& features, const Vector& proportions) {
  const double golden = (1 + std::sqrt(5.)) / 2;
  for (const auto& [threshold, pull] : {std::pair(1.05, 0.3), std::pair(1.45, 0.15)})
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const double one : {-1., 1.})
        for (const double other : {-golden, golden}) {
          Vector corner{};
          corner[axis] = one;
          corner[(axis + 1) % 3] = other;
          corner = unit(corner);
          const std::size_t self = features.list().size();
          const std::size_t flip_of_y = axis == 0 ? 1 : axis == 1 ? 2 : 0;  // bit of `other` or of `one`
          features.add_alone({corner, threshold, -pull * (proportions * corner), self ^ flip_of_y});
        }
}

void add_limbs(Features& features, std::uint64_t count, Random& random) {
  std::vector<Vector> taken;
  const auto crowded = [&](const Vector& d) {
    return std::any_of(taken.begin(), taken.end(), [&](const Vector& t) { return dot(t, d) > 0.6; });
  };
  for (std::uint64_t i = 0; i < count; ++i) {
    Vector along = direction(random);
    for (int attempt = 0; attempt < 20 && crowded(along); ++attempt) along = direction(random);
    taken.push_back(along);
    taken.push_back(mirror(along));
    const double threshold = random.uniform(0.3, 0.9), reach = random.uniform(1.5, 3);
    const Vector move = reach / (ball_radius - threshold) * unit(along + 0.5 * direction(random));
    features.add(along, threshold, move);
  }
}

void add_arms(Features& features, std::uint64_t count, Random& random) {
  const double threshold = random.uniform(0.6, 0.9), reach = random.uniform(1.5, 3);
  const double lean = random.uniform(-0.4, 0.4), droop = random.uniform(-0.8, 0.8);
  const double cosine[] = {-0.5, 0, (std::sqrt(5.) - 1) / 4, 0.5};  // of a third, a quarter, a fifth, a sixth of a turn
  const double c = cosine[count - 3], s = std::sqrt(1 - c * c);
  const std::size_t first = features.list().size();
  double x = 1, y = 0;
  for (std::size_t arm = 0; arm < count; ++arm) {
    const Vector move = reach / (ball_radius - threshold) * unit({x, y, droop});
    features.add_alone({unit({x, y, lean}), threshold, move, first + (count - arm) % count});
    std::tie(x, y) = std::pair(c * x - s * y, s * x + c * y);
  }
}

void add_bends(Features& features, std::uint64_t count, const Vector& proportions, Random& random) {
  for (std::uint64_t i = 0; i < count; ++i) {
    const Vector along = unit(proportions * proportions * direction(random));
    const double threshold = random.uniform(-0.6, 0.6), amount = random.uniform(0.3, 0.9);
    const Vector move = amount * direction_across(along, random);
    features.add(along, threshold, move);
  }
}

void add_cup(Features& features, const Vector& axis, Random& random) {
  const double amount = random.uniform(0.2, 0.5), height = std::sqrt(0.75);
  const Vector x = direction_across(axis, random), y = cross(axis, x);
  for (const Vector& d : {x, 0.5 * x + height * y, -0.5 * x + height * y})
    for (const Vector& out : {d, -d}) features.add(out, 0.3, -amount * axis);
}

void fill_with_small_features(Features& features, Random& random) {
  for (bool room = true; room;) {
    const Vector along = direction(random), move = 0.03 * direction(random);
    room = features.add(along, random.uniform(-1.2, 1.2), move);
  }
}

}  // namespace mercury
