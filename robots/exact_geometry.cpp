// SPDX-License-Identifier: Apache-2.0
// The only file that includes CGAL, which compiles slowly: its kernel and number types, which are under the LGPL.
#include "robots/exact_geometry.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>

namespace mercury {
namespace {

using Whole = CGAL::Simple_cartesian<CGAL::Mpzf>;  // no division
using Fractions = CGAL::Simple_cartesian<CGAL::Exact_rational>;

template <class Kernel>
typename Kernel::Point_3 exact(const Vec3& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

std::strong_ordering ordering(CGAL::Comparison_result result) { return static_cast<int>(result) <=> 0; }

}  // namespace

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return Whole::Orientation_3()(exact<Whole>(a), exact<Whole>(b), exact<Whole>(c), exact<Whole>(d));
}

int exact_side_of_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p) {
  return Whole::Side_of_oriented_sphere_3()(exact<Whole>(a), exact<Whole>(b), exact<Whole>(c), exact<Whole>(d),
                                            exact<Whole>(p));
}

bool are_exactly_collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  return Whole::Collinear_3()(exact<Whole>(a), exact<Whole>(b), exact<Whole>(c));
}

struct ExactSquaredRadius::Fraction {
  CGAL::Exact_rational value;
};

ExactSquaredRadius::ExactSquaredRadius(std::span<const Vec3> points, const Tetrahedron& t)
    : value_(std::make_shared<const Fraction>(
          Fraction{CGAL::squared_radius(exact<Fractions>(points[t[0]]), exact<Fractions>(points[t[1]]),
                                        exact<Fractions>(points[t[2]]), exact<Fractions>(points[t[3]]))})) {}

Bounds ExactSquaredRadius::bounds() const {
  const auto [low, high] = CGAL::to_interval(value_->value);
  return {low, high};
}

std::strong_ordering ExactSquaredRadius::compare(const ExactSquaredRadius& other) const {
  return ordering(CGAL::compare(value_->value, other.value_->value));
}

std::strong_ordering ExactSquaredRadius::compare(double other) const {
  return ordering(CGAL::compare(value_->value, CGAL::Exact_rational(other)));
}

}  // namespace mercury
