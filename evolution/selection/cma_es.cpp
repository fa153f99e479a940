// SPDX-License-Identifier: Apache-2.0
// CMA-ES: evolution with a normal distribution whose mean, step size and covariance adapt themselves (Hansen 2016, "The
// CMA Evolution Strategy: A Tutorial", arXiv:1604.00772, appendix A; parameters are those of its table 1, negative
// weights included). Separable CMA-ES has a diagonal covariance, which learns (n + 2) / 3 times as fast, and no
// negative weights (Ros and Hansen 2008, "A Simple Modification in CMA-ES Achieving Linear Time and Space Complexity").
//
// Four things are as this project needs them:
// - Children are m + sigma C^1/2 z with the symmetric root of C, where the tutorial has B D z. Both have one
//   distribution, but the root does not depend on signs and order of eigenvectors, which rounding decides while C is
//   near the identity.
// - What learn() needs of the children it draws again, so that the state follows from seeds and scores.
// - The first individual is the start itself, z = 0. It counts as any other.
// - A search that stands still begins again with twice as many children (Auger and Hansen 2005, "A Restart CMA
// Evolution
//   Strategy With Increasing Population Size"): if the best score is the same for 10 + 30 n / lambda generations, if
//   the condition of C is above 1e14, or if all steps are below 1e-12 of the first ones. Unlike theirs, it begins at
//   the same mean, and no criterion reads differences of scores: their order is all that counts.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "evolution/selection/behavior.h"
#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"
#include "robots/portable_math.h"

namespace mercury {
namespace {

using Vector = std::vector<double>;

// The parameters for n numbers and lambda children.
struct Rates {
  Vector weights;             // per rank, the best first; the positive ones sum to 1
  std::size_t parents = 0;    // mu, ranks that move the mean
  double mass = 0;            // mu_eff
  double c_sigma, d_sigma;    // of the step size
  double c_c, c_1, c_mu;      // of the covariance
  double expected_length;     // of a normal vector
  std::size_t postponed = 0;  // generations between two decompositions of C

  // Of children that all move the mean: the better half of twice as many.
  static Rates of_parents(std::size_t n, std::size_t parents) {
    Rates rates(n, 2 * parents, false);
    rates.weights.resize(parents);
    return rates;
  }
  Rates(std::size_t n, std::size_t lambda, bool separable) : weights(lambda), parents(lambda / 2) {
    const auto dimensions = static_cast<double>(n);
    double positive = 0, negative = 0, squares = 0, negative_squares = 0;
    for (std::size_t i = 0; i < lambda; ++i) {
      const double w = portable_log((static_cast<double>(lambda) + 1) / 2 / static_cast<double>(i + 1));
      weights[i] = w;
      (i < parents ? positive : negative) += std::abs(w);
      (i < parents ? squares : negative_squares) += w * w;
    }
    if (lambda == 1) weights[0] = positive = squares = 1, parents = 1, negative = 0;
    mass = positive * positive / squares;
    const double negative_mass = negative > 0 ? negative * negative / negative_squares : 0;
    c_sigma = (mass + 2) / (dimensions + mass + 5);
    d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mass - 1) / (dimensions + 1)) - 1) + c_sigma;
    c_c = (4 + mass / dimensions) / (dimensions + 4 + 2 * mass / dimensions);
    const double faster = separable ? (dimensions + 2) / 3 : 1;
    c_1 = std::min(1.0, faster * 2 / ((dimensions + 1.3) * (dimensions + 1.3) + mass));
    c_mu = std::min(1 - c_1, faster * 2 * (0.25 + mass + 1 / mass - 2) / ((dimensions + 2) * (dimensions + 2) + mass));
    expected_length = std::sqrt(dimensions) * (1 - 1 / (4 * dimensions) + 1 / (21 * dimensions * dimensions));
    double below = 0;  // the negative weights sum to minus this
    if (c_mu > 0 && negative > 0 && !separable)
      below = std::min({1 + c_1 / c_mu, 1 + 2 * negative_mass / (mass + 2), (1 - c_1 - c_mu) / (dimensions * c_mu)});
    for (std::size_t i = 0; i < lambda; ++i)
      weights[i] = i < parents ? weights[i] / positive : below * weights[i] / std::max(negative, 1e-300);
    const double lag = 1 / (10 * dimensions * (c_1 + c_mu));
    postponed = lag > 1 ? static_cast<std::size_t>(lag) : 1;
  }
};

// A covariance matrix with its root.
class Covariance {
 public:
  virtual ~Covariance() = default;
  // C^1/2 z, of the last decomposition.
  virtual Vector stretched(const Vector& z) const = 0;
  // keep C + c_1 path path^T + the sum of weights[i] steps[i] steps[i]^T
  virtual void update(double keep, double c_1, const Vector& path, const Vector& weights,
                      const std::vector<Vector>& steps) = 0;
  // False if the condition is above 1e14, so that C cannot be used any more.
  virtual bool decompose() = 0;
  virtual double largest_variance() const = 0;

 protected:
  static constexpr double worst_condition = 1e14;
};

template <class Matrix>
auto& at(Matrix& matrix, std::size_t i, std::size_t k) {
  return matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
}

class FullCovariance : public Covariance {
 public:
  explicit FullCovariance(std::size_t n)
      : matrix_(Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n))), root_(matrix_) {
  }

  Vector stretched(const Vector& z) const override {
    Vector y(z.size(), 0);
    for (std::size_t k = 0; k < z.size(); ++k)
      for (std::size_t i = 0; i < z.size(); ++i) y[i] += at(root_, i, k) * z[k];
    return y;
  }
  void update(double keep, double c_1, const Vector& path, const Vector& weights,
              const std::vector<Vector>& steps) override {
    matrix_ *= keep;
    add(c_1, path);
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (weights[i] != 0) add(weights[i], steps[i]);
  }
  bool decompose() override {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix_);
    const Eigen::VectorXd& values = solver.eigenvalues();  // ascending
    const double largest = values[values.size() - 1];
    if (solver.info() != Eigen::Success || !(largest <= worst_condition * values[0])) return false;
    const Eigen::MatrixXd& vectors = solver.eigenvectors();
    const std::size_t n = static_cast<std::size_t>(values.size());
    root_.setZero();
    for (std::size_t k = 0; k < n; ++k) {
      const double deviation = std::sqrt(values[static_cast<Eigen::Index>(k)]);
      for (std::size_t j = 0; j < n; ++j) {
        const double scaled = deviation * at(vectors, j, k);
        for (std::size_t i = 0; i < n; ++i) at(root_, i, j) += scaled * at(vectors, i, k);
      }
    }
    return true;
  }
  double largest_variance() const override { return matrix_.diagonal().maxCoeff(); }

 private:
  void add(double weight, const Vector& v) {
    for (std::size_t k = 0; k < v.size(); ++k)
      for (std::size_t i = 0; i < v.size(); ++i) at(matrix_, i, k) += weight * (v[i] * v[k]);
  }

  Eigen::MatrixXd matrix_, root_;
};

class DiagonalCovariance : public Covariance {
 public:
  explicit DiagonalCovariance(std::size_t n) : variances_(n, 1), deviations_(n, 1) {}

  Vector stretched(const Vector& z) const override {
    Vector y(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) y[i] = deviations_[i] * z[i];
    return y;
  }
  void update(double keep, double c_1, const Vector& path, const Vector& weights,
              const std::vector<Vector>& steps) override {
    for (std::size_t k = 0; k < variances_.size(); ++k) {
      double variance = keep * variances_[k] + c_1 * (path[k] * path[k]);
      for (std::size_t i = 0; i < steps.size(); ++i) variance += weights[i] * (steps[i][k] * steps[i][k]);
      variances_[k] = variance;
    }
  }
  bool decompose() override {
    const auto [smallest, largest] = std::ranges::minmax(variances_);
    if (!(largest <= worst_condition * smallest)) return false;
    for (std::size_t i = 0; i < variances_.size(); ++i) deviations_[i] = std::sqrt(variances_[i]);
    return true;
  }
  double largest_variance() const override { return std::ranges::max(variances_); }

 private:
  Vector variances_, deviations_;
};

// The distribution: its mean, step size and covariance.
class Distribution {
 public:
  explicit Distribution(bool separable = false) : separable_(separable) {}

  void reset(Vector mean, double step) {
    const std::size_t n = mean.size();
    mean_ = std::move(mean);
    sigma_ = first_step_ = step;
    sigma_path_.assign(n, 0);
    path_.assign(n, 0);
    if (separable_)
      covariance_ = std::make_unique<DiagonalCovariance>(n);
    else
      covariance_ = std::make_unique<FullCovariance>(n);
    forgotten_ = 1;
    since_decomposition_ = 0;
  }

  std::size_t dimensions() const { return mean_.size(); }
  Vector drawn(Random& random) const {
    Vector z(mean_.size());
    for (double& number : z) number = random.normal();
    return z;
  }
  Vector child(const Vector& z) const {
    Vector numbers = covariance_->stretched(z);
    for (std::size_t k = 0; k < mean_.size(); ++k) numbers[k] = mean_[k] + sigma_ * numbers[k];
    return numbers;
  }

  // Learns from the z of children, the best first, as many as the rates are for. Returns false if the distribution
  // cannot be used any more.
  bool learn(const std::vector<Vector>& z, const Rates& rates) {
    const std::size_t n = mean_.size(), lambda = z.size();
    Vector mean_z(n, 0), mean_y(n, 0), weights(lambda);
    std::vector<Vector> ranked(lambda);
    for (std::size_t rank = 0; rank < lambda; ++rank) {
      ranked[rank] = covariance_->stretched(z[rank]);
      double w = rates.weights[rank];
      if (rank < rates.parents) {
        for (std::size_t k = 0; k < n; ++k) {
          mean_z[k] += w * z[rank][k];
          mean_y[k] += w * ranked[rank][k];
        }
      } else if (const double squared = squared_length(z[rank]); squared > 0) {
        w *= static_cast<double>(n) / squared;
      }
      weights[rank] = rates.c_mu * w;
    }
    for (std::size_t k = 0; k < n; ++k) mean_[k] += sigma_ * mean_y[k];
    // C^-1/2 of the mean step is the mean of z.
    const double of_sigma = std::sqrt(rates.c_sigma * (2 - rates.c_sigma) * rates.mass);
    for (std::size_t k = 0; k < n; ++k) sigma_path_[k] = (1 - rates.c_sigma) * sigma_path_[k] + of_sigma * mean_z[k];
    const double length = std::sqrt(squared_length(sigma_path_));
    forgotten_ *= (1 - rates.c_sigma) * (1 - rates.c_sigma);
    const bool stalls = length / std::sqrt(1 - forgotten_) >=
                        (1.4 + 2 / (static_cast<double>(n) + 1)) * rates.expected_length;  // h_sigma = 0
    const double of_c = stalls ? 0 : std::sqrt(rates.c_c * (2 - rates.c_c) * rates.mass);
    for (std::size_t k = 0; k < n; ++k) path_[k] = (1 - rates.c_c) * path_[k] + of_c * mean_y[k];
    double sum = 0;
    for (const double w : rates.weights) sum += w;
    const double lost = stalls ? rates.c_1 * rates.c_c * (2 - rates.c_c) : 0;
    covariance_->update(1 + lost - rates.c_1 - rates.c_mu * sum, rates.c_1, path_, weights, ranked);
    sigma_ *= portable_exp(rates.c_sigma / rates.d_sigma * (length / rates.expected_length - 1));
    bool usable = true;
    if (++since_decomposition_ >= rates.postponed) {
      usable = covariance_->decompose();
      since_decomposition_ = 0;
    }
    const bool converged = sigma_ * std::sqrt(covariance_->largest_variance()) < 1e-12 * first_step_;
    return usable && !converged && std::isfinite(sigma_);
  }

 private:
  static double squared_length(const Vector& v) {
    double sum = 0;
    for (const double x : v) sum += x * x;
    return sum;
  }

  bool separable_;
  Vector mean_, sigma_path_, path_;
  double sigma_ = 1, first_step_ = 1;
  std::unique_ptr<Covariance> covariance_;
  double forgotten_ = 1;  // (1 - c_sigma)^(2 g), of the path's start
  std::size_t since_decomposition_ = 0;
};

// As whose child the lineage shows those of a distribution.
std::vector<std::size_t> best_of_last_generation(std::span<const Individual> living) {
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < living.size(); ++i)
    if (best.empty() || living[i].generation > living[best.front()].generation) best = {i};
  return best;
}

class CovarianceMatrixAdaptation : public Algorithm {
 public:
  CovarianceMatrixAdaptation(const AlgorithmSettings& settings, bool separable)
      : settings_(settings), separable_(separable), distribution_(separable) {
    reset();
  }

  void begin(std::span<const double> numbers, double step) override {
    start_.assign(numbers.begin(), numbers.end());
    first_step_ = step;
    restarts_ = 0;
    is_first_ = true;
    reset();
  }

  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    std::vector<ChildPlan> plans(children << restarts_);
    const std::vector<std::size_t> parents = best_of_last_generation(living);
    for (std::size_t i = 0; i < plans.size(); ++i) {
      plans[i].parents = parents;
      if (!is_start(i)) plans[i].numbers = distribution_.child(distribution_.drawn(random));
    }
    return plans;
  }

  void learn(std::span<const Individual> born, Random random) override {
    if (start_.empty() || born.empty()) return;
    const std::size_t n = start_.size(), lambda = born.size();
    std::vector<Vector> z(lambda, Vector(n, 0)), ranked;
    for (std::size_t i = 0; i < lambda; ++i)
      if (!is_start(i)) z[i] = distribution_.drawn(random);
    is_first_ = false;
    const std::vector<std::size_t> order = best_first(born);
    for (const std::size_t i : order) ranked.push_back(std::move(z[i]));
    const bool usable = distribution_.learn(ranked, Rates(n, lambda, separable_));
    note_best(born[order.front()].score());
    const std::size_t patience = 10 + (30 * n + lambda - 1) / lambda;
    if (usable && same_best_ < patience) return;
    if (restarts_ < most_restarts) ++restarts_;
    reset();
  }

  // The best one so far, then the best children; if those are too few, the next best.
  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t living) const override {
    const std::vector<std::size_t> order = best_first(pool);
    std::vector<std::size_t> chosen = order;
    std::stable_partition(chosen.begin(), chosen.end(),  // clang 14 lacks that of ranges
                          [&](std::size_t i) { return i == order.front() || i >= living; });
    chosen.resize(std::min(chosen.size(), settings_.population));
    std::ranges::sort(chosen, [&](std::size_t a, std::size_t b) { return better(pool[a], pool[b]); });
    return chosen;
  }

 private:
  static constexpr int most_restarts = 9;

  void reset() {
    distribution_.reset(start_, first_step_);
    same_best_ = 0;
    last_best_ = std::numeric_limits<double>::quiet_NaN();
  }

  bool is_start(std::size_t child) const { return is_first_ && child == 0; }

  void note_best(double score) {
    same_best_ = score == last_best_ ? same_best_ + 1 : 0;
    last_best_ = score;
  }

  const AlgorithmSettings settings_;
  const bool separable_;
  Vector start_;
  double first_step_ = 1;
  Distribution distribution_;
  std::size_t same_best_ = 0;
  double last_best_ = 0;
  int restarts_ = 0;
  bool is_first_ = true;
};

// CMA-ME (Fontaine, Togelius, Nikolaidis and Hoover 2020, "Covariance Matrix Adaptation for the Rapid Illumination of
// Behavior Space", algorithm 1, with improvement emitters): some CMA-ES fill a map of elites. A child that fills an
// empty cell ranks before all that improve a cell; among either, more improvement is better; the others do not count.
// An emitter whose children improve nothing begins again at an elite that is drawn at random. The map and the emitters
// follow from the children, which learn() draws again.
class MapOfEmitters : public Algorithm {
 public:
  explicit MapOfEmitters(const AlgorithmSettings& settings)
      : map_(settings), emitters_(std::max<std::size_t>(1, settings.population / children_per_emitter)) {
    begin({}, step_);
  }

  void begin(std::span<const double> numbers, double step) override {
    start_.assign(numbers.begin(), numbers.end());
    step_ = step;
    is_first_ = true;
    elites_.clear();
    for (Distribution& emitter : emitters_) emitter.reset(start_, step);
  }

  // The emitters' children take turns.
  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    std::vector<ChildPlan> plans(children);
    const std::vector<std::size_t> parents = best_of_last_generation(living);
    for (std::size_t i = 0; i < children; ++i) {
      plans[i].parents = parents;
      const Distribution& emitter = emitters_[i % emitters_.size()];
      if (!is_start(i)) plans[i].numbers = emitter.child(emitter.drawn(random));
    }
    return plans;
  }

  void learn(std::span<const Individual> born, Random random) override {
    if (start_.empty()) return;
    struct Improvement {
      bool is_new;
      double by;
      Vector z;
    };
    std::vector<std::vector<Improvement>> improvements(emitters_.size());
    for (std::size_t i = 0; i < born.size(); ++i) {
      const Distribution& emitter = emitters_[i % emitters_.size()];
      Vector z = is_start(i) ? Vector(start_.size(), 0) : emitter.drawn(random);
      const double score = comparable(born[i].score());
      if (score == worst_score || born[i].assessment.values.empty()) continue;
      const auto [place, is_new] = elites_.try_emplace(map_.cell_of(born[i]), Elite{score, {}});
      const double by = is_new ? score : score - place->second.score;
      if (!is_new && by <= 0) continue;
      place->second = {score, emitter.child(z)};
      improvements[i % emitters_.size()].push_back({is_new, by, std::move(z)});
    }
    is_first_ = false;
    for (std::size_t e = 0; e < emitters_.size(); ++e) {
      std::ranges::stable_sort(improvements[e], [](const Improvement& a, const Improvement& b) {
        return a.is_new != b.is_new ? a.is_new : a.by > b.by;
      });
      std::vector<Vector> ranked;
      for (Improvement& one : improvements[e]) ranked.push_back(std::move(one.z));
      const bool usable =
          !ranked.empty() && emitters_[e].learn(ranked, Rates::of_parents(start_.size(), ranked.size()));
      if (!usable && !elites_.empty())
        emitters_[e].reset(std::next(elites_.begin(), std::ptrdiff_t(random.below(elites_.size())))->second.numbers,
                           step_);
    }
  }

  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t) const override {
    return map_.elites(pool);
  }

 private:
  static constexpr std::size_t children_per_emitter = 36;
  struct Elite {
    double score;
    Vector numbers;
  };

  bool is_start(std::size_t child) const { return is_first_ && child == 0; }

  const CellMap map_;
  std::vector<Distribution> emitters_;
  Vector start_;
  double step_ = 1;
  std::map<std::size_t, Elite> elites_;  // by cell
  bool is_first_ = true;
};

}  // namespace

AlgorithmDescription cma_es() {
  return {.name = "cma-es",
          .help = "CMA-ES, for muscles and brains: a distribution of numbers that learns how they go together",
          .of_numbers = true,
          .learns = true,
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<CovarianceMatrixAdaptation>(settings, false);
          }};
}

AlgorithmDescription cma_me() {
  return {.name = "cma-me",
          .help = "CMA-ME: CMA-ES that fill the map of map-elites, for muscles and brains",
          .of_numbers = true,
          .of_behavior = true,
          .has_map = true,
          .learns = true,
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<MapOfEmitters>(settings);
          }};
}

AlgorithmDescription sep_cma_es() {
  return {.name = "sep-cma-es",
          .help = "separable CMA-ES, for hundreds of weights: a distribution that learns the scale of each number",
          .of_numbers = true,
          .learns = true,
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<CovarianceMatrixAdaptation>(settings, true);
          }};
}

}  // namespace mercury
