// SPDX-License-Identifier: Apache-2.0
// Random search, the baseline: every robot is new, the best ones live on.
#include <algorithm>

#include "evolution/selection/order.h"
#include "evolution/selection/registry.h"

namespace mercury {
namespace {

class RandomSearch : public Algorithm {
 public:
  explicit RandomSearch(const AlgorithmSettings& settings) : settings_(settings) {}

  std::vector<ChildPlan> plan(std::span<const Individual>, std::size_t children, Random&) const override {
    return std::vector<ChildPlan>(children);
  }

  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t) const override {
    std::vector<std::size_t> order = best_first(pool);
    order.resize(std::min(order.size(), settings_.population));
    return order;
  }

 private:
  const AlgorithmSettings settings_;
};

}  // namespace

AlgorithmDescription random_search() {
  return {.name = "random",
          .help = "random search, the baseline: every robot is new",
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<RandomSearch>(settings);
          }};
}

}  // namespace mercury
