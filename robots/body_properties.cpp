// SPDX-License-Identifier: Apache-2.0
// Vibrations of a body. A spring between the masses a and b along the unit vector n has the energy k/2 (n.(u_b -
// u_a))^2 for small displacements u, so that
//
//   M u'' = -K u - D u',   K = sum of k (n n^T on a and b),   D = sum of tau k (n n^T on a and b)
//
// With masses divided out, A = M^-1/2 K M^-1/2, the eigenvalues of A are the squares of angular frequencies.
//
// The slowest one. (A + s)^-1 turns the smallest eigenvalues of A into the largest, which Lanczos' method finds first.
// A has as many eigenvalues of zero as there are motions that deform no spring: six of a rigid body, and any number of
// hinges and loose masses. A start vector in the range of A has no part of them, and the shift s makes A + s
// invertible.
//
// The largest time step. Symplectic Euler with D evaluated before the step is, with a = dt^2 u.Au and b = dt u.Bu for a
// vibration u of length 1 (B is D with masses divided out),
//
//   u(n+1) - 2 u(n) + u(n-1) = -a u(n) - b (u(n) - u(n-1)),   z^2 - (2 - a - b) z + (1 - b) = 0
//
// It becomes unstable where a root reaches z = -1: a + 2 b = 4, or w^2 dt^2 + 2 tau w^2 dt = 4 for one relaxation time.
// So the largest dt is the one at which the largest eigenvalue of dt^2 A + 2 dt B is 4.
#include "mercury/body_properties.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "mercury/inspect.h"
#include "mercury/random.h"

namespace mercury {
namespace {

using Vector = Eigen::VectorXd;

// A spring between two points that are not fixed, or one such point and one that is.
struct Bond {
  static constexpr Eigen::Index fixed = -1;
  std::array<Eigen::Index, 2> at;        // the first of the point's three coordinates, or fixed
  std::array<double, 2> inverse_root{};  // 1/sqrt(mass) [kg^-1/2]
  Eigen::Vector3d direction;             // unit vector
  double stiffness = 0, damping = 0;     // k [N/m], tau k [N s/m]
};

Eigen::Vector3d in_double(Vec3 v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

struct Bonds {
  std::vector<Bond> all;
  Eigen::Index coordinates = 0;  // three per point that is not fixed
  bool any_damping = false;
};

Bonds bonds_of(const Robot& robot, double stiffness_scale) {
  Bonds bonds;
  std::vector<Eigen::Index> place(robot.masses.size());
  for (const std::uint16_t point : robot.fixed) place[point] = Bond::fixed;
  for (Eigen::Index& at : place)
    if (at != Bond::fixed) at = std::exchange(bonds.coordinates, bonds.coordinates + 3);
  const auto materials = materials_of(robot);
  for (const Spring& spring : robot.springs) {
    const Eigen::Vector3d along = in_double(robot.masses[spring.b]) - in_double(robot.masses[spring.a]);
    const Material& material = materials[spring.material];
    const double length = along.norm(), stiffness = stiffness_scale * static_cast<double>(material.stiffness);
    if (!(length > 0 && stiffness > 0) || (place[spring.a] == Bond::fixed && place[spring.b] == Bond::fixed)) continue;
    const auto root = [&](std::size_t point) { return 1 / std::sqrt(static_cast<double>(mass_of(robot, point))); };
    bonds.all.push_back({{place[spring.a], place[spring.b]},
                         {root(spring.a), root(spring.b)},
                         along / length,
                         stiffness,
                         stiffness * static_cast<double>(material.relaxation_time)});
  }
  bonds.any_damping = std::ranges::any_of(bonds.all, [](const Bond& bond) { return bond.damping > 0; });
  return bonds;
}

// The rate at which a bond gets longer while coordinates, scaled by the roots of masses, change by x.
double lengthening(const Bond& bond, const Vector& x) {
  double sum = 0;
  if (bond.at[0] != Bond::fixed) sum -= bond.inverse_root[0] * bond.direction.dot(x.segment<3>(bond.at[0]));
  if (bond.at[1] != Bond::fixed) sum += bond.inverse_root[1] * bond.direction.dot(x.segment<3>(bond.at[1]));
  return sum;
}

// (by_stiffness A + by_damping B) x
Vector product(const Bonds& bonds, const Vector& x, double by_stiffness, double by_damping) {
  Vector result = Vector::Zero(x.size());
  for (const Bond& bond : bonds.all) {
    const double pull = (by_stiffness * bond.stiffness + by_damping * bond.damping) * lengthening(bond, x);
    if (bond.at[0] != Bond::fixed) result.segment<3>(bond.at[0]) -= bond.inverse_root[0] * pull * bond.direction;
    if (bond.at[1] != Bond::fixed) result.segment<3>(bond.at[1]) += bond.inverse_root[1] * pull * bond.direction;
  }
  return result;
}

Vector random_vector(Eigen::Index size) {
  Random random(1);
  Vector x(size);
  for (double& number : x) number = random.normal();
  return x.normalized();
}

// Eigenvalues and vectors of a symmetric operator on the space that its powers make of a start vector.
class Lanczos {
 public:
  explicit Lanczos(Vector start) { basis_.push_back(std::move(start)); }

  // One more dimension. Returns false if the space holds all that the operator makes of the start vector.
  template <class Operator>
  bool extend(const Operator& apply) {
    Vector next = apply(basis_.back());
    diagonal_.push_back(basis_.back().dot(next));
    // Twice against all: rounding would otherwise let eigenvectors that are found come back.
    for (int pass = 0; pass < 2; ++pass)
      for (const Vector& one : basis_) next -= one.dot(next) * one;
    const double size = next.norm();
    solve();
    beside_.push_back(size);
    if (size <= 1e-13 * std::abs(values_[values_.size() - 1])) return false;
    basis_.push_back(next / size);
    return true;
  }

  // Rising, of the space of the last extend() but one vector.
  const Vector& values() const { return values_; }
  // How far the value is from an eigenvalue of the operator, at most.
  double error(Eigen::Index i) const { return std::abs(beside_.back() * vectors_(vectors_.rows() - 1, i)); }
  Vector vector(Eigen::Index i) const {
    Vector sum = Vector::Zero(basis_.front().size());
    for (Eigen::Index k = 0; k < vectors_.rows(); ++k) sum += vectors_(k, i) * basis_[static_cast<std::size_t>(k)];
    return sum.normalized();
  }

 private:
  void solve() {
    const auto size = static_cast<Eigen::Index>(diagonal_.size());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(Vector::Map(diagonal_.data(), size),
                                  Vector::Map(beside_.data(), static_cast<Eigen::Index>(beside_.size())));
    values_ = solver.eigenvalues();
    vectors_ = solver.eigenvectors();
  }

  std::vector<Vector> basis_;
  std::vector<double> diagonal_, beside_;  // of the tridiagonal matrix
  Vector values_;
  Eigen::MatrixXd vectors_;
};

struct Mode {
  double value = 0;
  Vector vector;
};

// The largest eigenvalue of by_stiffness A + by_damping B.
Mode stiffest(const Bonds& bonds, double by_stiffness, double by_damping) {
  constexpr int most = 150;
  Lanczos space(random_vector(bonds.coordinates));
  for (int i = 1;; ++i) {
    const bool more = space.extend([&](const Vector& x) { return product(bonds, x, by_stiffness, by_damping); });
    const Eigen::Index last = space.values().size() - 1;
    if (const double value = space.values()[last]; !more || i == most || space.error(last) < 1e-5 * value)
      return {value, space.vector(last)};
  }
}

double largest_dt(const Bonds& bonds, const Mode& stiffest_without_damping) {
  // Each vibration allows a dt; that of the stiffest one at this dt is nearer to the smallest of them.
  Vector vibration = stiffest_without_damping.vector;
  double dt = INFINITY;
  constexpr int most = 10;
  for (int i = 0; i < most; ++i) {
    const double a = vibration.dot(product(bonds, vibration, 1, 0)), b = vibration.dot(product(bonds, vibration, 0, 1));
    const double allowed = 4 / (b + std::sqrt(b * b + 4 * a));  // a dt^2 + 2 b dt = 4
    if (!bonds.any_damping) return allowed;
    if (allowed > (1 - 1e-4) * dt) return std::min(dt, allowed);
    dt = allowed;
    vibration = stiffest(bonds, dt * dt, 2 * dt).vector;
  }
  return dt;
}

// The smallest eigenvalue of A above zero. `largest`: its largest one.
std::optional<double> softest(const Bonds& bonds, double largest) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Bond& bond : bonds.all)
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) {
        if (bond.at[p] == Bond::fixed || bond.at[q] == Bond::fixed || bond.at[p] < bond.at[q]) continue;
        const double factor = (p == q ? 1 : -1) * bond.stiffness * bond.inverse_root[p] * bond.inverse_root[q];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            entries.emplace_back(bond.at[p] + i, bond.at[q] + j, factor * bond.direction[i] * bond.direction[j]);
      }
  const double shift = 1e-7 * largest, zero = 1e-10 * largest;
  for (Eigen::Index i = 0; i < bonds.coordinates; ++i) entries.emplace_back(i, i, shift);
  Eigen::SparseMatrix<double> shifted(bonds.coordinates, bonds.coordinates);
  shifted.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factors(shifted);
  if (factors.info() != Eigen::Success) return std::nullopt;

  constexpr int most = 120;
  Lanczos space(product(bonds, random_vector(bonds.coordinates), 1, 0).normalized());
  for (int i = 1;; ++i) {
    const bool more = space.extend([&](const Vector& x) -> Vector { return factors.solve(x); });
    for (Eigen::Index k = space.values().size() - 1; k >= 0; --k) {
      const double inverse = space.values()[k], value = 1 / inverse - shift;
      if (value < zero) continue;
      if (!more || space.error(k) < 1e-6 * inverse) return value;
      break;
    }
    if (!more || i == most) return std::nullopt;
  }
}

}  // namespace

BodyProperties body_properties(const Robot& robot, double stiffness_scale) {
  BodyProperties found;
  for (std::size_t i = 0; i < robot.masses.size(); ++i) found.mass += static_cast<double>(mass_of(robot, i));
  const Inspection body = inspect(robot);
  if (body.closed && body.volume > 0) {
    found.density = found.mass / body.volume;
    double sum = 0;
    for (const Spring& spring : robot.springs)
      sum += static_cast<double>(materials_of(robot)[spring.material].stiffness) *
             std::pow(static_cast<double>(spring.rest_length), 2);
    found.modulus = stiffness_scale * sum / (6 * body.volume);
  }
  const Bonds bonds = bonds_of(robot, stiffness_scale);
  if (bonds.all.empty()) return found;
  const Mode fastest = stiffest(bonds, 1, 0);
  found.largest_dt = largest_dt(bonds, fastest);
  if (robot.masses.size() > most_masses_with_modes) return found;
  if (const std::optional<double> slowest = softest(bonds, fastest.value))
    found.lowest_frequency = std::sqrt(*slowest) / (2 * std::numbers::pi);
  return found;
}

}  // namespace mercury
