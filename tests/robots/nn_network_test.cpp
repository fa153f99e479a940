// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "mercury/error.h"
#include "mercury/network.h"
#include "mercury/random.h"
#include "robots/nn/perceptron.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

Network random_network(const std::vector<int>& sizes, std::uint64_t seed) {
  Random random(seed);
  Network network;
  for (std::size_t l = 0; l + 1 < sizes.size(); ++l) {
    Layer layer{sizes[l], sizes[l + 1], {}, {}};
    for (int i = 0; i < layer.inputs * layer.outputs; ++i)
      layer.weights.push_back(static_cast<float>(random.normal() / std::sqrt(layer.inputs)));
    for (int i = 0; i < layer.outputs; ++i) layer.biases.push_back(static_cast<float>(random.normal()));
    network.layers.push_back(layer);
  }
  return network;
}

std::vector<float> random_points(std::size_t numbers, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> points(numbers);
  for (float& x : points) x = static_cast<float>(random.normal());
  return points;
}

// W2 max(0, W1 x + b1) + b2 ..., in the order that evaluate() promises.
template <typename Real>
std::vector<Real> by_hand(const Network& network, std::span<const float> point) {
  std::vector<Real> values(point.begin(), point.end());
  for (std::size_t l = 0; l < network.layers.size(); ++l) {
    const Layer& layer = network.layers[l];
    std::vector<Real> next;
    for (std::size_t row = 0; row < layer.biases.size(); ++row) {
      Real sum = layer.biases[row];
      for (std::size_t k = 0; k < values.size(); ++k) sum += Real(layer.weights[row * values.size() + k]) * values[k];
      next.push_back(l + 1 < network.layers.size() && sum < 0 ? 0 : sum);
    }
    values = next;
  }
  return values;
}

struct Change {
  std::size_t numbers = 0, changed = 0;
  double sum = 0, sum_of_squares = 0;
};

Change change(const Network& before, const Network& after) {
  Change result;
  const auto compare = [&](const std::vector<float>& a, const std::vector<float>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double difference = static_cast<double>(b[i]) - a[i];
      ++result.numbers;
      result.changed += difference != 0;
      result.sum += difference;
      result.sum_of_squares += difference * difference;
    }
  };
  for (std::size_t l = 0; l < before.layers.size(); ++l) {
    compare(before.layers[l].weights, after.layers[l].weights);
    compare(before.layers[l].biases, after.layers[l].biases);
  }
  return result;
}

TEST(Network, AgreesWithACalculationInDoublePrecision) {
  for (const std::vector<int>& sizes : {std::vector{3, 64, 64, 25}, {3, 25}, {5, 7, 1, 33, 25}}) {
    const Network network = random_network(sizes, 1);
    const auto inputs = static_cast<std::size_t>(sizes[0]);
    const std::vector<float> points = random_points(inputs * 200, 2);
    const std::vector<float> outputs = evaluate(network, points);
    ASSERT_EQ(outputs.size(), 200u * 25);
    for (std::size_t p = 0; p < 200; ++p) {
      const auto expected = by_hand<double>(network, std::span(points).subspan(p * inputs, inputs));
      for (std::size_t k = 0; k < 25; ++k) EXPECT_NEAR(outputs[p * 25 + k], expected[k], 2e-5);
    }
  }
}

TEST(Network, SumsInTheOrderOfItsInputsAndRoundsAfterEachStep) {
  // With every instruction set, for widths and numbers of points that fill vectors and tiles or do not.
  for (std::size_t kernel = 0; kernel < perceptron_kernels(); ++kernel)
    for (const std::vector<int>& sizes : {std::vector{3, 64, 64, 25}, {5, 17, 40, 25}, {3, 25}, {1, 16, 1, 33, 25}})
      for (const std::size_t count : {1u, 64u, 100u}) {
        const Network network = random_network(sizes, 3);
        const auto inputs = static_cast<std::size_t>(sizes.front());
        const std::vector<float> points = random_points(inputs * count, 4);
        const std::vector<float> outputs = evaluate_layers(network.layers, points, kernel);
        ASSERT_EQ(outputs.size(), 25 * count);
        for (std::size_t p = 0; p < count; ++p) {
          const auto expected = by_hand<float>(network, std::span(points).subspan(p * inputs, inputs));
          for (std::size_t k = 0; k < 25; ++k) EXPECT_EQ(outputs[p * 25 + k], expected[k]);
        }
      }
}

TEST(Network, NaNReachesTheResult) {
  Network network = random_network({3, 8, 8, 25}, 5);
  network.layers[0].weights[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(evaluate(network, random_points(3, 6))[0]));
}

TEST(Network, NamesWhatDoesNotFit) {
  Network network = random_network({3, 8, 25}, 7);
  EXPECT_NO_THROW(validate(network));
  EXPECT_EQ(sizes_of(network), (std::vector{3, 8, 25}));
  EXPECT_EQ(refusal([] { validate(Network{}); }), "network: 1 to 16 layers are accepted");
  Network wrong = network;
  wrong.layers[1].inputs = 7;
  EXPECT_EQ(refusal([&] { validate(wrong); }), "network: a layer of 7 inputs follows one of 8 outputs");
  wrong = network;
  wrong.layers[0].weights.pop_back();
  EXPECT_EQ(refusal([&] { validate(wrong); }),
            "network: a layer of 3 inputs and 8 outputs has 23 weights and 8 biases");
  EXPECT_EQ(refusal([] {
              validate(random_network({3, 24}, 1), "/origin");
            }),
            "/origin: the last layer gives 25 numbers (a place and 22 scores) or 29 (four fields as well), not 24");
  EXPECT_THROW(evaluate(network, random_points(4, 1)), InputError);
}

TEST(Softmax, GivesProbabilitiesInTheRatioOfTheExponentials) {
  const std::vector<double> p = softmax(std::vector{1.f, 2.f, -3.f});
  EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.), 1, 1e-15);
  EXPECT_NEAR(p[1] / p[0], std::exp(1.), 1e-12);
  EXPECT_NEAR(p[2] / p[0], std::exp(-4.), 1e-12);
  EXPECT_THAT(softmax(std::vector{1e4f, 1e4f}), testing::ElementsAre(0.5, 0.5));
  EXPECT_THAT(softmax(std::vector{-3e38f, 3e38f}), testing::ElementsAre(0, 1));
}

TEST(Softmax, TheMostProbableIsTheOneWithTheLargestScore) {
  Random random(8);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<float> scores(22);
    for (float& s : scores) s = static_cast<float>(random.uniform(-5, 5));
    const std::vector<double> p = softmax(scores);
    const auto best = static_cast<std::size_t>(std::max_element(p.begin(), p.end()) - p.begin());
    EXPECT_EQ(most_probable(scores), best);
  }
  EXPECT_EQ(most_probable(std::vector{1.f, 4.f, 4.f, 2.f}), 1u);
}

TEST(Mutation, ChangesTheGivenShareByTheGivenSize) {
  const Network network = random_network({3, 64, 64, 25}, 9);
  const Change c = change(network, mutate(network, 0.25, 0.5, 10));
  const auto n = static_cast<double>(c.numbers), changed = static_cast<double>(c.changed);
  EXPECT_EQ(c.numbers, 3u * 64 + 64 + 64 * 64 + 64 + 64 * 25 + 25);
  EXPECT_NEAR(changed / n, 0.25, 5 * std::sqrt(0.25 * 0.75 / n));
  EXPECT_NEAR(c.sum / changed, 0, 5 * 0.5 / std::sqrt(changed));
  EXPECT_NEAR(c.sum_of_squares / changed, 0.25, 5 * 0.25 * std::sqrt(2 / changed));
}

TEST(Mutation, OfRateOrSizeZeroChangesNothing) {
  const Network network = random_network({3, 8, 25}, 11);
  EXPECT_EQ(mutate(network, 0, 1, 12), network);
  EXPECT_EQ(mutate(network, 1, 0, 12), network);
}

TEST(Mutation, ChangesAtLeastOneWeight) {
  const Network network = random_network({3, 25}, 11);  // 100 numbers
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    EXPECT_NE(mutate(network, 0.01, 1, seed), network);
    EXPECT_NE(mutate(network, 1e-12, 1, seed), network);
    EXPECT_NE(mutate(network, 1, 1e-30, seed), network);  // steps far below the precision of a float
  }
}

TEST(Mutation, DependsOnItsSeedAlone) {
  const Network network = random_network({3, 8, 25}, 13);
  EXPECT_EQ(mutate(network, 0.5, 1, 14), mutate(network, 0.5, 1, 14));
  EXPECT_NE(mutate(network, 0.5, 1, 14), mutate(network, 0.5, 1, 15));
}

TEST(Mutation, RefusesSharesAndSizesOutOfRange) {
  const Network network = random_network({3, 25}, 16);
  for (const double rate : {-0.1, 1.1, std::nan("")}) EXPECT_THROW(mutate(network, rate, 1, 1), InputError);
  for (const double size : {-1., std::nan(""), HUGE_VAL}) EXPECT_THROW(mutate(network, 1, size, 1), InputError);
}

TEST(Crossover, InheritsEveryNeuronWholeFromOneOfItsParents) {
  const Network a = random_network({3, 64, 64, 25}, 17), b = random_network({3, 64, 64, 25}, 18);
  const Network child = crossover(a, b, 19);
  int neurons = 0, of_b = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    const auto inputs = static_cast<std::ptrdiff_t>(child.layers[l].inputs);
    const auto row = [&](const Network& network, std::ptrdiff_t neuron) {
      const auto begin = network.layers[l].weights.begin() + neuron * inputs;
      std::vector<float> numbers(begin, begin + inputs);
      numbers.push_back(network.layers[l].biases[static_cast<std::size_t>(neuron)]);
      return numbers;
    };
    for (std::ptrdiff_t neuron = 0; neuron < child.layers[l].outputs; ++neuron, ++neurons) {
      const auto inherited = row(child, neuron);
      of_b += inherited == row(b, neuron);
      EXPECT_TRUE(inherited == row(a, neuron) || inherited == row(b, neuron));
    }
  }
  EXPECT_NEAR(of_b, neurons / 2., 5 * std::sqrt(neurons / 4.));
  EXPECT_EQ(child, crossover(a, b, 19));
  EXPECT_NE(child, crossover(a, b, 20));
  EXPECT_EQ(crossover(a, a, 21), a);
}

TEST(Crossover, NeedsEqualSizes) {
  EXPECT_EQ(refusal([] {
              crossover(random_network({3, 8, 25}, 1), random_network({3, 9, 25}, 1), 1);
            }),
            "crossover: two networks of equal sizes are needed");
}

}  // namespace
}  // namespace mercury
