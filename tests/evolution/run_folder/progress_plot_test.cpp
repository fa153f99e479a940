// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "evolution/run_folder/plot.h"
#include "tests/evolution/run_folder/test_run.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(PlotAxes, TicksAreRoundNumbersWithinTheRange) {
  EXPECT_THAT(ticks_in({0, 10}, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(ticks_in({-1, 1}, 4), ElementsAre(-1, -0.5, 0, 0.5, 1));
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    const double low = random.normal() * std::exp(random.uniform(-200, 200));
    const Range range = widened({low, low + std::exp(random.uniform(-200, 200))});
    const int most = 2 + static_cast<int>(random.below(10));
    const std::vector<double> ticks = ticks_in(range, most);
    ASSERT_LE(ticks.size(), static_cast<std::size_t>(most) + 1);
    const double tolerance = 1e-6 * (range.high - range.low);
    for (const double tick : ticks) {
      ASSERT_GE(tick, range.low - tolerance);
      ASSERT_LE(tick, range.high + tolerance);
    }
  }
}

TEST(PlotAxes, TicksHaveAsManyDigitsAsTheyNeed) {
  EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_text(3, 1), "3");
  EXPECT_EQ(tick_text(25'000, 5'000), "25,000");
  EXPECT_EQ(tick_text(1e-17, 0.1), "0");
  EXPECT_EQ(tick_text(-2, 1), "\u22122");
}

class ProgressPlot : public RunFolderTest {
 protected:
  // The plot of a run whose scores are given by generation and child.
  std::string plot_of(int generations, const std::function<double(int, std::size_t)>& score) const {
    RunFolder run = create("run", test_settings(generations));
    Evolution evolution(run.history().settings().evolution, run.space());
    for (int g = 0; g <= generations; ++g) {
      std::vector<Individual> children = evolution.children();
      for (std::size_t i = 0; i < children.size(); ++i)
        children[i].assessment = {.fate = Fate::sound, .scores = {score(g, i)}};
      run.append(evolution.select(std::move(children)), {});
    }
    return progress_plot(run.history());
  }
};

TEST_F(ProgressPlot, OfARunWithoutGenerationsHasAxes) {
  const RunFolder run = create("run");
  EXPECT_THAT(progress_plot(run.history()), HasSubstr("distance [m]"));
}

TEST_F(ProgressPlot, NamesTheLastBestAndMedian) {
  const std::string plot = plot_of(3, [](int g, std::size_t) { return 10.0 * g + 1; });
  EXPECT_THAT(plot, HasSubstr(">31</text>"));
}

TEST_F(ProgressPlot, HasNoCoordinatesThatAreNoNumbers) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double value : {-inf, inf, 0.0, 1e308, -1e308, 1e-308, 1e20}) {
    std::filesystem::remove_all(path("run"));
    const std::string plot = plot_of(3, [&](int g, std::size_t i) { return i % 2 == 0 ? value : g + 0.1; });
    EXPECT_THAT(plot, Not(HasSubstr("nan"))) << value;
    EXPECT_THAT(plot, Not(HasSubstr("inf"))) << value;
    std::filesystem::remove_all(path("run"));
    const std::string same = plot_of(2, [&](int, std::size_t) { return value; });
    EXPECT_THAT(same, Not(HasSubstr("nan"))) << value;
    EXPECT_THAT(same, Not(HasSubstr("inf"))) << value;
  }
}

}  // namespace
}  // namespace mercury
