// SPDX-License-Identifier: Apache-2.0
// CMA-ES on functions with known optima, against its tutorial computed the plain way, and against the numbers of
// evaluations that its author's program needs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "mercury/algorithm.h"
#include "mercury/error.h"
#include "mercury/evolution.h"
#include "tests/evolution/vector_genome.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using Numbers = std::vector<double>;
using Function = std::function<double(const Numbers&)>;

// --- Functions to minimize

double sphere(const Numbers& x) {
  return std::transform_reduce(x.begin(), x.end(), 0.0, std::plus{}, [](double v) { return v * v; });
}
// The condition of the Hessian is 1e6.
double ellipsoid(const Numbers& x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += std::pow(1e6, static_cast<double>(i) / static_cast<double>(x.size() - 1)) * x[i] * x[i];
  return sum;
}
double rosenbrock(const Numbers& x) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    sum += 100 * std::pow(x[i] * x[i] - x[i + 1], 2) + std::pow(x[i] - 1, 2);
  return sum;
}
double rastrigin(const Numbers& x) {
  double sum = 0;
  for (const double v : x) sum += v * v + 10 - 10 * std::cos(2 * std::numbers::pi * v);
  return sum;
}
Function rotated(Function function, std::size_t n) {
  Random random(7);
  Eigen::MatrixXd drawn(n, n);
  for (double& number : drawn.reshaped()) number = random.normal();
  const Eigen::MatrixXd rotation = Eigen::HouseholderQR<Eigen::MatrixXd>(drawn).householderQ();
  return [function, rotation](const Numbers& x) {
    const Eigen::VectorXd turned = rotation * Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x));
    return function({turned.begin(), turned.end()});
  };
}

// --- A search without genomes

struct Problem {
  Function function;
  Numbers start;
  double step = 1;
  std::size_t population = 10;
  std::function<double(double)> score = [](double value) { return -value; };
};

class Search {
 public:
  Search(const std::string& name, Problem problem, std::uint64_t seed)
      : algorithm_(make_algorithm({.name = name, .population = problem.population})), problem_(std::move(problem)),
        seed_(seed) {
    algorithm_->begin(problem_.start, problem_.step);
  }

  // The children of the next generation; the plan without numbers is the start.
  std::vector<Numbers> children() const {
    Random random = this->random();
    std::vector<Numbers> children;
    for (const ChildPlan& plan : algorithm_->plan({}, problem_.population, random))
      children.push_back(plan.numbers.empty() ? problem_.start : plan.numbers);
    return children;
  }
  void advance() {
    std::vector<Individual> born;
    for (const Numbers& child : children()) {
      const double value = problem_.function(child);
      Individual& individual = born.emplace_back(Individual{.id = evaluations_++});
      individual.assessment = {.fate = Fate::sound, .scores = {problem_.score(value)}};
      best_ = std::min(best_, value);
    }
    algorithm_->learn(born, random());
    ++generation_;
  }
  // Evaluations until the value is reached, or more than `most`.
  std::size_t evaluations_to(double value, std::size_t most) {
    while (best_ > value && evaluations_ <= most) advance();
    return evaluations_;
  }
  Random random() const { return Random(seed_of(seed_, generation_)); }

 private:
  std::unique_ptr<Algorithm> algorithm_;
  const Problem problem_;
  const std::uint64_t seed_;
  std::uint64_t generation_ = 0;
  std::size_t evaluations_ = 0;
  double best_ = std::numeric_limits<double>::infinity();
};

double median_evaluations(const std::string& name, const Problem& problem, std::size_t most, std::uint64_t runs = 11) {
  std::vector<double> evaluations;
  for (std::uint64_t seed = 1; seed <= runs; ++seed)
    evaluations.push_back(static_cast<double>(Search(name, problem, seed).evaluations_to(1e-10, most)));
  std::ranges::nth_element(evaluations, evaluations.begin() + std::ssize(evaluations) / 2);
  return evaluations[evaluations.size() / 2];
}

// --- The tutorial's algorithm

// Hansen 2016, appendix A, with eigenvectors, and the inverse root where the tutorial has it.
class Tutorial {
 public:
  Tutorial(const Problem& problem, bool separable)
      : n_(static_cast<double>(problem.start.size())), lambda_(static_cast<double>(problem.population)),
        separable_(separable),
        mean_(Eigen::Map<const Eigen::VectorXd>(problem.start.data(), std::ssize(problem.start))), sigma_(problem.step),
        covariance_(Eigen::MatrixXd::Identity(mean_.size(), mean_.size())),
        sigma_path_(Eigen::VectorXd::Zero(mean_.size())), path_(sigma_path_) {}

  Eigen::VectorXd child(const Eigen::VectorXd& z) const { return mean_ + sigma_ * root() * z; }

  // Children in the order of their values.
  void learn(const std::vector<Eigen::VectorXd>& children) {
    const auto mu = static_cast<std::size_t>(lambda_ / 2);
    std::vector<double> w;
    for (double i = 1; i <= lambda_; ++i) w.push_back(std::log((lambda_ + 1) / 2) - std::log(i));
    const auto sum = [&](std::size_t first, std::size_t end, int power) {
      double total = 0;
      for (std::size_t i = first; i < end; ++i) total += std::pow(w[i], power);
      return total;
    };
    const double positive = sum(0, mu, 1), negative = -sum(mu, w.size(), 1);
    const double mass = std::pow(positive, 2) / sum(0, mu, 2),
                 negative_mass = std::pow(negative, 2) / sum(mu, w.size(), 2);
    const double c_sigma = (mass + 2) / (n_ + mass + 5),
                 d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mass - 1) / (n_ + 1)) - 1) + c_sigma,
                 c_c = (4 + mass / n_) / (n_ + 4 + 2 * mass / n_);
    const double faster = separable_ ? (n_ + 2) / 3 : 1;
    const double c_1 = faster * 2 / (std::pow(n_ + 1.3, 2) + mass);
    const double c_mu = std::min(1 - c_1, faster * 2 * (0.25 + mass + 1 / mass - 2) / (std::pow(n_ + 2, 2) + mass));
    const double below =
        separable_ ? 0 : std::min({1 + c_1 / c_mu, 1 + 2 * negative_mass / (mass + 2), (1 - c_1 - c_mu) / (n_ * c_mu)});
    for (double& weight : w) weight *= weight >= 0 ? 1 / positive : below / negative;

    const Eigen::MatrixXd inverse = root().inverse();
    std::vector<Eigen::VectorXd> y;
    for (const Eigen::VectorXd& child : children) y.emplace_back((child - mean_) / sigma_);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(mean_.size());
    for (std::size_t i = 0; i < mu; ++i) step += w[i] * y[i];
    mean_ += sigma_ * step;
    sigma_path_ = (1 - c_sigma) * sigma_path_ + std::sqrt(c_sigma * (2 - c_sigma) * mass) * (inverse * step);
    const double expected = std::sqrt(n_) * (1 - 1 / (4 * n_) + 1 / (21 * n_ * n_));
    sigma_ *= std::exp(c_sigma / d_sigma * (sigma_path_.norm() / expected - 1));
    const bool moves = sigma_path_.norm() / std::sqrt(1 - std::pow(1 - c_sigma, 2 * (generation_ + 1))) <
                       (1.4 + 2 / (n_ + 1)) * expected;
    path_ = (1 - c_c) * path_ + (moves ? std::sqrt(c_c * (2 - c_c) * mass) : 0) * step;
    const double lost = moves ? 0 : c_c * (2 - c_c);
    covariance_ *= 1 + c_1 * lost - c_1 - c_mu * sum(0, w.size(), 1);
    covariance_ += c_1 * path_ * path_.transpose();
    for (std::size_t i = 0; i < w.size(); ++i) {
      const double length = (inverse * y[i]).squaredNorm();
      const double weight = w[i] >= 0 ? w[i] : length > 0 ? w[i] * n_ / length : 0;
      covariance_ += c_mu * weight * y[i] * y[i].transpose();
    }
    if (separable_) covariance_ = Eigen::MatrixXd(covariance_.diagonal().asDiagonal());
    ++generation_;
  }

 private:
  Eigen::MatrixXd root() const { return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance_).operatorSqrt(); }

  const double n_, lambda_;
  const bool separable_;
  Eigen::VectorXd mean_;
  double sigma_;
  Eigen::MatrixXd covariance_;
  Eigen::VectorXd sigma_path_, path_;
  double generation_ = 0;
};

class CmaEs : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Both, CmaEs, testing::Values("cma-es", "sep-cma-es"),
                         [](const auto& test) { return test.param == "cma-es" ? "full" : "separable"; });

// In 5 dimensions C is decomposed in every generation, as in the tutorial.
TEST_P(CmaEs, IsThatOfTheTutorial) {
  for (const Function& function : {Function(sphere), Function(ellipsoid), Function(rosenbrock)}) {
    const Problem problem{.function = function, .start = Numbers(5, 0.5), .step = 0.3, .population = 8};
    Search search(GetParam(), problem, 3);
    Tutorial tutorial(problem, GetParam() == "sep-cma-es");
    for (int generation = 0; generation < 40; ++generation) {
      std::vector<Numbers> children = search.children();
      Random random = search.random();
      std::vector<Eigen::VectorXd> expected;
      for (std::size_t i = 0; i < children.size(); ++i) {
        Eigen::VectorXd z = Eigen::VectorXd::Zero(5);
        if (generation > 0 || i > 0)
          for (double& number : z) number = random.normal();
        expected.push_back(tutorial.child(z));
        for (std::size_t k = 0; k < 5; ++k)
          ASSERT_NEAR(children[i][k], expected[i][static_cast<Eigen::Index>(k)], 1e-9) << generation;
      }
      std::vector<std::size_t> order(children.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::ranges::stable_sort(order, {}, [&](std::size_t i) { return function(children[i]); });
      std::vector<Eigen::VectorXd> ranked;
      for (const std::size_t i : order) ranked.push_back(expected[i]);
      tutorial.learn(ranked);
      search.advance();
    }
  }
}

// --- What it does not depend on

TEST_P(CmaEs, DependsOnTheOrderOfScoresAlone) {
  Problem problem{.function = rosenbrock, .start = Numbers(6, 0.0), .step = 0.5, .population = 10};
  Search plain(GetParam(), problem, 1);
  problem.score = [](double value) { return 7 - 3 * std::sqrt(value); };
  Search other(GetParam(), problem, 1);
  for (int generation = 0; generation < 200; ++generation) {
    ASSERT_EQ(plain.children(), other.children()) << generation;
    plain.advance(), other.advance();
  }
}

TEST_P(CmaEs, DoesNotDependOnTheUnit) {
  constexpr double unit = 1024;  // a power of two, so that nothing is rounded
  const Problem problem{.function = ellipsoid, .start = Numbers(6, 0.5), .step = 0.3, .population = 10};
  Problem scaled = problem;
  scaled.function = [](Numbers x) {
    for (double& v : x) v /= unit;
    return ellipsoid(x);
  };
  for (double& v : scaled.start) v *= unit;
  scaled.step *= unit;
  Search small(GetParam(), problem, 1), large(GetParam(), scaled, 1);
  for (int generation = 0; generation < 100; ++generation) {
    std::vector<Numbers> children = small.children();
    for (Numbers& child : children)
      for (double& v : child) v *= unit;
    ASSERT_EQ(children, large.children()) << generation;
    small.advance(), large.advance();
  }
}

TEST_P(CmaEs, DoesNotDependOnTheOrigin) {
  const Problem problem{.function = ellipsoid, .start = Numbers(6, 0.5), .step = 0.3, .population = 10};
  Problem shifted = problem;
  shifted.function = [](Numbers x) {
    for (double& v : x) v -= 3;
    return ellipsoid(x);
  };
  for (double& v : shifted.start) v += 3;
  Search here(GetParam(), problem, 1), there(GetParam(), shifted, 1);
  for (int generation = 0; generation < 60; ++generation) {
    const std::vector<Numbers> children = here.children(), others = there.children();
    for (std::size_t i = 0; i < children.size(); ++i)
      for (std::size_t k = 0; k < 6; ++k) ASSERT_NEAR(children[i][k] + 3, others[i][k], 1e-9) << generation;
    here.advance(), there.advance();
  }
}

// --- How many evaluations it takes

// Medians to 1e-10. The references are those of 21 runs of pycma 4.5.0, by the author of CMA-ES, with the same start,
// step and population and without its stops; its quartiles lie within 9 % of the median. It adapts the step size with
// other constants than the tutorial, so 15 % are allowed. (barecmaes, his plain version without negative weights,
// documents one run on the ellipsoid that needs 6,000 evaluations to 5e-10.)
struct Reference {
  std::string algorithm;
  std::string name;
  Problem problem;
  double evaluations;
};

std::vector<Reference> references() {
  const auto from = [](double x, std::size_t n) { return Numbers(n, x); };
  return {{"cma-es", "sphere", {.function = sphere, .start = from(0.5, 10), .step = 0.3, .population = 10}, 1550},
          {"cma-es", "ellipsoid", {.function = ellipsoid, .start = from(0.5, 10), .step = 0.3, .population = 10}, 4180},
          {"cma-es",
           "rotated_ellipsoid",
           {.function = rotated(ellipsoid, 10), .start = from(0.5, 10), .step = 0.3, .population = 10},
           4120},
          {"cma-es", "rosenbrock", {.function = rosenbrock, .start = from(0, 8), .step = 0.5, .population = 10}, 3780}};
}

class Evaluations : public testing::TestWithParam<Reference> {};
INSTANTIATE_TEST_SUITE_P(OfPycma, Evaluations, testing::ValuesIn(references()),
                         [](const auto& test) { return test.param.name; });

TEST_P(Evaluations, AreAsManyAsTheReferenceNeeds) {
  const Reference& reference = GetParam();
  const double median = median_evaluations(reference.algorithm, reference.problem, 100'000);
  RecordProperty("median", std::to_string(median));
  EXPECT_NEAR(median, reference.evaluations, 0.15 * reference.evaluations);
}

// Ros and Hansen 2008: on separable functions the diagonal is learned in a number of evaluations that grows about as n,
// and on others it is of no use.
TEST(SeparableCmaEs, LearnsScalesFasterAndRotationsNotAtAll) {
  const Problem straight{.function = ellipsoid, .start = Numbers(20, 0.5), .step = 0.3, .population = 12};
  Problem turned = straight;
  turned.function = rotated(ellipsoid, 20);
  const double separable = median_evaluations("sep-cma-es", straight, 100'000, 5),
               full = median_evaluations("cma-es", straight, 100'000, 5);
  EXPECT_LT(separable, full / 1.5);
  EXPECT_NEAR(median_evaluations("cma-es", turned, 100'000, 5), full, full / 10);
  const auto most = static_cast<std::size_t>(5 * full);
  EXPECT_GT(median_evaluations("sep-cma-es", turned, most, 3), static_cast<double>(most));
}

// Hansen and Kern 2004, "Evaluating the CMA Evolution Strategy on Multimodal Test Functions": where there are many
// minima, large populations find the best one, and small ones another.
TEST(CmaEsOnManyMinima, ALargePopulationFindsTheBest) {
  const auto found = [](std::size_t population, std::size_t evaluations) {
    const Problem problem{.function = rastrigin, .start = Numbers(10, 2.0), .step = 2, .population = population};
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed)
      count += Search("cma-es", problem, seed).evaluations_to(1e-10, evaluations) <= evaluations ? 1 : 0;
    return count;
  };
  EXPECT_GE(found(400, 50'000), 9);
  EXPECT_LE(found(10, 3'000), 1);
}

// Auger and Hansen 2005: restarts with twice the population find it from any population.
TEST_P(CmaEs, BeginsAgainWithTwiceThePopulationWhereItStandsStill) {
  const Problem problem{.function = rastrigin, .start = Numbers(5, 2.0), .step = 2, .population = 8};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Search search(GetParam(), problem, seed);
    EXPECT_LT(search.evaluations_to(1e-10, 100'000), 100'000u) << seed;
  }
  Search flat(GetParam(), {.function = [](const Numbers&) { return 1.0; }, .start = Numbers(5, 0.0), .population = 8},
              1);
  for (int generation = 0; generation < 35; ++generation) flat.advance();
  EXPECT_EQ(flat.children().size(), 16u);  // after 10 + 30 * 5 / 8 generations without a change
}

// --- In an evolution

EvolutionSettings vector_settings(const std::string& name) {
  EvolutionSettings settings{.generations = 10};
  settings.algorithm = {.name = name, .population = 8};
  return settings;
}

// Bodies of vectors, and others that are no vectors.
class FounderSpace : public VectorSpace {
 public:
  explicit FounderSpace(std::size_t founders) : VectorSpace(4), founders_(founders) {}
  std::size_t founders() const override { return founders_; }

 private:
  std::size_t founders_;
};
class OpaqueGenome : public VectorGenome {
 public:
  using VectorGenome::VectorGenome;
  std::vector<double> numbers() const override { return {}; }
};
class OpaqueSpace : public VectorSpace {
 public:
  GenomePointer random(std::uint64_t, std::uint64_t) const override {
    return std::make_shared<OpaqueGenome>(std::vector<double>{1, 2});
  }
};

std::string refusal(const EvolutionSettings& settings, const GenomeSpace& space) {
  return mercury::refusal<ParameterError>([&] { const Evolution evolution(settings, space); });
}

TEST_P(CmaEs, BeginsWithTheFounder) {
  const FounderSpace space(1);
  VectorAssessor assessor;
  Evolution evolution(vector_settings(GetParam()), space);
  const std::optional<Generation> first = evolution.advance(assessor);
  ASSERT_EQ(first->born.size(), 8u);
  EXPECT_EQ(first->born[0].genome->numbers().size(), 4u);
  EXPECT_THAT(first->born[0].parents, testing::IsEmpty());
  const std::optional<Generation> second = evolution.advance(assessor);
  const std::uint64_t best =
      std::ranges::max_element(first->born, {}, [](const Individual& child) { return child.score(); })->id;
  for (const Individual& child : second->born) EXPECT_THAT(child.parents, testing::ElementsAre(best));
}

TEST_P(CmaEs, RefusesWhatIsNoVectorAndSeveralStarts) {
  EXPECT_EQ(refusal(vector_settings(GetParam()), FounderSpace(1)), "");
  EXPECT_EQ(refusal(vector_settings(GetParam()), FounderSpace(3)),
            "algorithm: " + GetParam() + " begins with one robot, and there are 3");
  EXPECT_THAT(refusal(vector_settings(GetParam()), OpaqueSpace()), testing::HasSubstr("a fixed list of numbers"));
  EXPECT_EQ(refusal(vector_settings("ga"), OpaqueSpace()), "");
  EvolutionSettings settings = vector_settings(GetParam());
  settings.children = 4;
  EXPECT_THAT(refusal(settings, FounderSpace(1)), testing::StartsWith("children: "));
}

// Such as that of a program that rounds in another way.
TEST_P(CmaEs, ARunIsNotContinuedWhereItsRobotsWouldBeOthers) {
  const FounderSpace space(1);
  VectorAssessor assessor;
  Evolution evolution(vector_settings(GetParam()), space);
  std::vector<Individual> born;
  for (int generation = 0; generation < 3; ++generation)
    std::ranges::move(evolution.advance(assessor)->born, std::back_inserter(born));
  Evolution same(vector_settings(GetParam()), space), other(vector_settings(GetParam()), space);
  EXPECT_NO_THROW(same.restore(2, evolution.living(), born));
  born[3].assessment.scores = {1.0};  // now it was the best of generation 0
  EXPECT_THROW(other.restore(2, evolution.living(), born), InputError);
}

TEST(CmaEsPopulation, IsThatOfTheTutorialWhereNoneIsGiven) {
  EXPECT_EQ(usual_population("cma-es", VectorSpace(10), 1), 10u);       // 4 + 3 ln 10 = 10.9
  EXPECT_EQ(usual_population("sep-cma-es", VectorSpace(100), 1), 17u);  // 17.8
  EXPECT_EQ(usual_population("ga", VectorSpace(10), 1), AlgorithmSettings{}.population);
}

}  // namespace
}  // namespace mercury
