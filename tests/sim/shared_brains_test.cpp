// SPDX-License-Identifier: Apache-2.0
// Simulation::shared_brains(): weights and states of all brains as arrays that a program reads and writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "shared_batch.h"
#include "tests/refusal.h"
#include "thinkers.h"

namespace mercury {
namespace {

using test::SharedBatch;
using test::thinker;

class SharedBrains : public test::SharedBatchTest {
 protected:
  static constexpr std::size_t count = 5;
  const Configuration configuration_{.environment = Ocean{}};
  SharedBatch thinkers() const { return batch(configuration_, std::vector<Robot>(count, thinker())); }
};
INSTANTIATE_TEST_SUITE_P(All, SharedBrains, test::every_backend, test::SharedBatchTest::name);

// Of robot `robot`, other numbers than those of its file.
std::vector<float> weights_for(std::size_t robot, std::size_t size) {
  std::vector<float> weights;
  for (std::size_t i = 0; i < size; ++i) weights.push_back(0.4f * std::sin(static_cast<float>(1 + 3 * i + 17 * robot)));
  return weights;
}

template <class T>
std::vector<T> row(const std::vector<T>& all, std::size_t number, std::size_t columns) {
  return {all.begin() + static_cast<std::ptrdiff_t>(number * columns),
          all.begin() + static_cast<std::ptrdiff_t>((number + 1) * columns)};
}

std::vector<float> all_weights(std::size_t robots, std::size_t columns) {
  std::vector<float> all;
  for (std::size_t i = 0; i < robots; ++i)
    for (const float weight : weights_for(i, columns)) all.push_back(weight);
  return all;
}

TEST_P(SharedBrains, ShowWhatTheBrainsHave) {
  SharedBatch batch = thinkers();
  const BrainArrays arrays = batch->shared_brains();
  ASSERT_EQ(arrays.weights.rows, count);
  for (const std::int64_t steps : {0, 1, 130}) {
    batch->step(steps);
    const std::vector<float> weights = batch.read(arrays.weights), neurons = batch.read(arrays.neurons),
                             senses = batch.read(arrays.senses);
    for (std::size_t i = 0; i < count; ++i) {
      const BrainState state = batch->brain_state(i);
      EXPECT_EQ(row(weights, i, arrays.weights.columns), state.weights);
      EXPECT_EQ(row(neurons, i, arrays.neurons.columns), state.neurons);
      EXPECT_EQ(row(senses, i, arrays.senses.columns), state.senses);
    }
  }
  EXPECT_NE(batch.read(arrays.neurons)[0], 0);
}

TEST_P(SharedBrains, WrittenWeightsCountAsThoseThatAreSet) {
  SharedBatch written = thinkers(), set = thinkers();
  for (SharedBatch* batch : {&written, &set}) (*batch)->step(30);
  const BrainArrays arrays = written->shared_brains();
  written.write(arrays.weights, all_weights(count, arrays.weights.columns));
  for (std::size_t i = 0; i < count; ++i) set->set_brain_weights(i, weights_for(i, arrays.weights.columns));
  for (SharedBatch* batch : {&written, &set}) (*batch)->step(100);
  EXPECT_EQ(written->hashes(), set->hashes());
  EXPECT_NE(written->hash(0), written->hash(1));
}

TEST_P(SharedBrains, WrittenNeuronsAreWhatTheNextThoughtBeginsWith) {
  SharedBatch written = thinkers(), set = thinkers();
  const BrainArrays arrays = written->shared_brains();
  for (SharedBatch* batch : {&written, &set}) (*batch)->step(40);  // a thought is next
  std::vector<float> neurons = written.read(arrays.neurons);
  for (float& y : neurons) y = 0.5f - y;
  written.write(arrays.neurons, neurons);
  for (std::size_t i = 0; i < count; ++i) {
    BrainState state = set->brain_state(i);
    for (float& y : state.neurons) y = 0.5f - y;
    set->set_brain_state(i, state);
  }
  for (SharedBatch* batch : {&written, &set}) (*batch)->step(100);
  EXPECT_EQ(written->hashes(), set->hashes());
}

// What a program wrote and what functions change go together, in whatever order.
TEST_P(SharedBrains, FunctionsKeepWhatWasWritten) {
  SharedBatch batch = thinkers();
  const BrainArrays arrays = batch->shared_brains();
  const std::size_t columns = arrays.weights.columns;
  batch->step(30);
  const std::vector<float> weights = all_weights(count, columns);
  batch.write(arrays.weights, weights);
  batch->set_target(2, Vec3{1, 2, 3});
  EXPECT_EQ(batch.read(arrays.weights), weights);
  EXPECT_EQ(batch->brain_state(3).weights, weights_for(3, columns));
  batch->set_brain_weights(1, weights_for(8, columns));
  EXPECT_EQ(row(batch.read(arrays.weights), 1, columns), weights_for(8, columns));
  EXPECT_EQ(row(batch.read(arrays.weights), 3, columns), weights_for(3, columns));
  batch->clamp_neuron(0, 1, 0.75f);
  EXPECT_EQ(batch.read(arrays.neurons)[1], 0.75f);
  std::array<std::uint8_t, count> mask{0, 0, 1, 1, 0};
  batch->reset(mask);
  const std::vector<float> neurons = batch.read(arrays.neurons);
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<float> own = row(neurons, i, arrays.neurons.columns);
    EXPECT_EQ(own == std::vector<float>(own.size(), 0.0f), mask[i] != 0) << i;
  }
  EXPECT_EQ(row(batch.read(arrays.weights), 3, columns), weights_for(3, columns));
}

TEST_P(SharedBrains, ABatchThatIsResetRepeatsItself) {
  SharedBatch batch = thinkers();
  const BrainArrays arrays = batch->shared_brains();
  batch.write(arrays.weights, all_weights(count, arrays.weights.columns));
  batch->step(150);
  const std::vector<std::uint64_t> hashes = batch->hashes();
  const BatchState saved = batch->save();
  batch->step(80);
  const std::vector<std::uint64_t> later = batch->hashes();
  batch->restore(saved);
  EXPECT_EQ(batch->hashes(), hashes);
  batch->step(80);
  EXPECT_EQ(batch->hashes(), later);
  batch->reset();
  EXPECT_EQ(batch.read(arrays.neurons), std::vector<float>(count * arrays.neurons.columns, 0.0f));
  batch->step(150);
  EXPECT_EQ(batch->hashes(), hashes);
}

TEST_P(SharedBrains, OtherRobotsHaveOtherArrays) {
  SharedBatch batch = thinkers();
  const BrainArrays old = batch->shared_brains();
  const std::size_t columns = old.weights.columns;
  batch.write(old.weights, all_weights(count, columns));
  batch->step(40);
  batch->keep(std::array<std::size_t, 2>{4, 1});
  const BrainArrays arrays = batch->shared_brains();
  ASSERT_EQ(arrays.weights.rows, 2u);
  EXPECT_EQ(row(batch.read(arrays.weights), 0, columns), weights_for(4, columns));
  EXPECT_EQ(row(batch.read(arrays.weights), 1, columns), weights_for(1, columns));
  EXPECT_EQ(batch.read(old.weights), all_weights(count, columns));
  Robot other = thinker();
  other.brain->layers[1].bias = {0.1f, 0.2f};  // two weights more
  batch->add(other);
  EXPECT_THAT(refusal([&] { (void)batch->shared_brains(); }), testing::HasSubstr("as many weights"));
  Robot none = test::bar();
  SharedBatch without = this->batch(configuration_, std::span(&none, 1));
  EXPECT_THAT(refusal([&] { (void)without->shared_brains(); }), testing::HasSubstr("brains"));
}

}  // namespace
}  // namespace mercury
