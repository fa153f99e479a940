// SPDX-License-Identifier: Apache-2.0
// Features of a body, as neurons: how the initial weights of network robots make limbs, bends and cups.
//
// Weights drawn from one normal distribution grow the same body over and over, a lump with spikes: a sum of many small
// bends is again a normal cloud, and its outliers decide the alpha shape. So a few neurons get large weights, each
// drawn as a feature of a body. A feature is a neuron max(0, along . place - threshold). It is zero on one side of a
// plane and grows with the distance from it on the other side; the places there move by `move` times its value.
//
//        place before                    place after
//            .  .                           .  .
//          .  .  . |  .                   .  .  . |      .   <- the part beyond the plane,
//         . .  .  .| . .   -- limb -->   . .  .  .|   . .  .    pulled out along `move`
//          .  .  . |  .                   .  .  . |      .
//            .  .  |                        .  .  |
//               plane: along . place = threshold
//
// The other neurons have small weights, for evolution to change. Only + - * / and square roots are used, and no
// expression draws two random numbers in an order that the compiler may choose, so the weights are the same everywhere.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mercury/random.h"

namespace mercury {

using Vector = std::array<double, 3>;

inline Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Vector operator*(const Vector& a, const Vector& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
inline Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator-(const Vector& a) { return {-a[0], -a[1], -a[2]}; }
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector unit(const Vector& a) { return 1 / std::sqrt(dot(a, a)) * a; }
inline Vector mirror(const Vector& a) { return {a[0], -a[1], a[2]}; }

// A unit vector of random direction; the second one at right angles to a unit vector.
Vector direction(Random& random);
Vector direction_across(const Vector& axis, Random& random);

// The neuron max(0, along . place - threshold), which moves places by `move` times its value.
struct Feature {
  Vector along{};
  double threshold = 0;
  Vector move{};
  std::size_t twin = 0;  // index of its mirror image in y; its own index if it has none
};

// The features of a layer, at most as many as it has neurons for.
class Features {
 public:
  Features(std::size_t room, bool mirrored) : room_(room), mirrored_(mirrored) {}
  const std::vector<Feature>& list() const { return list_; }

  // Adds a feature, and in a mirrored body its mirror image. Returns false if there is no room.
  bool add(const Vector& along, double threshold, const Vector& move) {
    const std::size_t self = list_.size(), needed = mirrored_ ? 2 : 1;
    if (room_ - self < needed) return false;
    list_.push_back({along, threshold, move, self + needed - 1});
    if (mirrored_) list_.push_back({mirror(along), threshold, mirror(move), self});
    return true;
  }

  // Adds a feature whose mirror image, if any, is added by the caller. Does nothing if there is no room.
  void add_alone(const Feature& feature) {
    if (list_.size() < room_) list_.push_back(feature);
  }

 private:
  std::vector<Feature> list_;
  std::size_t room_;
  bool mirrored_;
};

// Draws in the outliers of a normal cloud, of which the alpha shape would make spikes. Pulls from twelve sides, the
// corners of an icosahedron, in two steps; leaves a ball whose skin has many points.
void gather(Features& features, const Vector& proportions);
// Pulls out caps of the ball, each in its own direction.
void add_limbs(Features& features, std::uint64_t count, Random& random);
// Pulls out three to six equal limbs around the z axis: a star.
void add_arms(Features& features, std::uint64_t count, Random& random);
// Shears everything beyond a plane sideways. Planes mostly stand across the long axes.
void add_bends(Features& features, std::uint64_t count, const Vector& proportions, Random& random);
// Moves the rim around an axis along that axis: a bell.
void add_cup(Features& features, const Vector& axis, Random& random);
// Fills the room that is left with features that move places by little.
void fill_with_small_features(Features& features, Random& random);

}  // namespace mercury
