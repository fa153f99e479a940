// SPDX-License-Identifier: Apache-2.0
// The only file that includes CGAL, which compiles slowly: its kernel and number types, which are under the LGPL.
#include "robots/nn/exact_geometry.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>
#include <gmp.h>

#include <cstdlib>
#include <new>

namespace mercury {
namespace {

using Whole = CGAL::Simple_cartesian<CGAL::Mpzf>;  // no division
using Fractions = CGAL::Simple_cartesian<CGAL::Exact_rational>;

// GMP ends the program when memory is short. With these functions it throws instead, through its own frames, which
// compilers give unwind tables on the machines that we know. It may then leak; no number breaks, since a number gets
// its memory before it changes. They fit numbers that GMP's own functions, malloc() and free(), have made.
void use_throwing_allocation() {
  static const bool once = [] {
    mp_set_memory_functions(
        [](std::size_t size) {
          void* const memory = std::malloc(size);
          return memory ? memory : throw std::bad_alloc();
        },
        [](void* old, std::size_t, std::size_t size) {
          void* const memory = std::realloc(old, size);
          return memory ? memory : throw std::bad_alloc();
        },
        [](void* memory, std::size_t) { std::free(memory); });
    return true;
  }();
  static_cast<void>(once);
}

template <class Kernel>
typename Kernel::Point_3 exact(const Vec3& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

std::strong_ordering ordering(CGAL::Comparison_result result) { return static_cast<int>(result) <=> 0; }

}  // namespace

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  use_throwing_allocation();
  return Whole::Orientation_3()(exact<Whole>(a), exact<Whole>(b), exact<Whole>(c), exact<Whole>(d));
}

int exact_side_of_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p) {
  use_throwing_allocation();
  return Whole::Side_of_oriented_sphere_3()(exact<Whole>(a), exact<Whole>(b), exact<Whole>(c), exact<Whole>(d),
                                            exact<Whole>(p));
}

bool are_exactly_collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  use_throwing_allocation();
  return Whole::Collinear_3()(exact<Whole>(a), exact<Whole>(b), exact<Whole>(c));
}

struct ExactSquaredRadius::Fraction {
  CGAL::Exact_rational value;
};

ExactSquaredRadius::ExactSquaredRadius(std::span<const Vec3> points, const Tetrahedron& t)
    : value_((use_throwing_allocation(), std::make_shared<const Fraction>(Fraction{CGAL::squared_radius(
                                             exact<Fractions>(points[t[0]]), exact<Fractions>(points[t[1]]),
                                             exact<Fractions>(points[t[2]]), exact<Fractions>(points[t[3]]))}))) {}

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
