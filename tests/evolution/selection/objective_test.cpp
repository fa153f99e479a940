// SPDX-License-Identifier: Apache-2.0
#include "mercury/objective.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <locale>
#include <string>
#include <thread>
#include <vector>

#include "mercury/error.h"
#include "mercury/individual.h"
#include "mercury/quantity.h"
#include "mercury/random.h"

namespace mercury {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// All quantities 0, except some.
std::vector<double> values_with(std::initializer_list<std::pair<const char*, double>> some) {
  std::vector<double> values(quantities().size(), 0);
  for (const auto& [name, value] : some) values.at(find_quantity(name).value()) = value;
  return values;
}

// The message of the error that a formula gives; empty if it is accepted.
std::string problem_of(const std::string& formula) {
  try {
    const Objective objective(formula);
    return {};
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.parameter(), "objective");
    EXPECT_THAT(error.problem(), Not(HasSubstr("\n")));
    return error.problem();
  }
}

TEST(Objective, FormulasHaveTheValueThatArithmeticGives) {
  const std::vector<double> values = values_with({{"distance", 3}, {"strain", 0.5}, {"path", 4}});
  EXPECT_EQ(Objective("distance").score(values), 3);
  EXPECT_EQ(Objective("distance - 0.5 * path").score(values), 1);
  EXPECT_EQ(Objective("2*(distance+path)^2").score(values), 98);
  EXPECT_EQ(Objective("-distance").score(values), -3);
  EXPECT_EQ(Objective("1e-1 * 1.5e+1").score(values), 1.5);
  EXPECT_EQ(Objective("min(distance, path) / max(1, strain)").score(values), 3);
  EXPECT_EQ(Objective("(strain <= 0.5) ? distance : 0").score(values), 3);
  EXPECT_EQ(Objective("(strain == 0.5 && path != 4) ? distance : 7").score(values), 7);
}

TEST(Objective, EveryQuantityIsAName) {
  for (std::size_t q = 0; q < quantities().size(); ++q) {
    std::vector<double> values(quantities().size(), 0);
    values[q] = 42;
    EXPECT_EQ(Objective(std::string(quantities()[q].name)).score(values), 42) << quantities()[q].name;
  }
}

TEST(Objective, WhatIsNoFiniteNumberIsTheWorstScore) {
  const std::vector<double> zeros = values_with({});
  EXPECT_EQ(Objective("0 / distance").score(zeros), worst_score);
  EXPECT_EQ(Objective("1 / distance").score(zeros), worst_score);
  EXPECT_EQ(Objective("sqrt(distance - 1)").score(zeros), worst_score);
  EXPECT_EQ(Objective("distance").score(values_with({{"distance", std::nan("")}})), worst_score);
  EXPECT_EQ(Objective("-distance").score(values_with({{"distance", std::numeric_limits<double>::infinity()}})),
            worst_score);
}

TEST(Objective, OtherNumbersOfValuesAreRefused) {
  EXPECT_THROW(Objective("distance").score(std::vector<double>(2)), std::invalid_argument);
}

TEST(Objective, AnUnknownNameIsNamedWithWhatWasMeant) {
  EXPECT_THAT(problem_of("distanse - strain"), AllOf(HasSubstr("no quantity distanse"), HasSubstr("mean distance?")));
  EXPECT_THAT(problem_of("muscle_shares"), HasSubstr("did you mean muscle_share?"));
  EXPECT_THAT(problem_of("happiness"), AllOf(HasSubstr("no quantity happiness"), HasSubstr("distance, speed")));
  EXPECT_THAT(problem_of("2 * sqr(distance)"), AllOf(HasSubstr("no function sqr"), HasSubstr("mean sqrt?")));
  EXPECT_THAT(problem_of("distance(2)"), HasSubstr("no function distance"));
}

TEST(Objective, MistakesGiveOneLineThatSaysWhere) {
  EXPECT_THAT(problem_of("distance -"), HasSubstr("unexpected end of expression"));
  EXPECT_THAT(problem_of("(distance"), HasSubstr("missing parenthesis"));
  EXPECT_THAT(problem_of("distance strain"), HasSubstr("\"strain\" at character 10"));
  EXPECT_THAT(problem_of(""), HasSubstr("empty"));
  EXPECT_THAT(problem_of("distance, strain"), HasSubstr("several formulas"));
  EXPECT_THAT(problem_of("distance = 100"), HasSubstr("write =="));
  EXPECT_THAT(problem_of("distance\n- strain"), HasSubstr("character 9"));
  EXPECT_THAT(problem_of("\"distance\""), HasSubstr("does not belong"));
  EXPECT_THAT(problem_of("d\xc3\xa9placement"), HasSubstr("character 2"));
  EXPECT_THAT(problem_of(std::string("distance\0", 9)), HasSubstr("character 9"));
  EXPECT_THAT(problem_of(std::string(2000, '1')), HasSubstr("at most 1000"));
}

TEST(Objective, OneObjectiveServesSeveralThreads) {
  const Objective objective("distance * path + strain");
  std::vector<int> wrong(8);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      const Objective copy = objective;
      for (int i = 0; i < 2000; ++i) {
        const double x = t + 1, y = i;
        wrong[static_cast<std::size_t>(t)] +=
            copy.score(values_with({{"distance", x}, {"path", y}, {"strain", 0.5}})) != x * y + 0.5;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(wrong, testing::Each(0));
}

TEST(Objective, DecimalsHaveAPointInEveryLocale) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  const double score = Objective("1.5 * distance").score(values_with({{"distance", 2}}));
  std::locale::global(before);
  EXPECT_EQ(score, 3);
}

// Random formulas, of pieces of real ones and of any characters: each is accepted or refused in one line.
TEST(Objective, RandomTextIsAcceptedOrRefusedInOneLine) {
  const std::vector<std::string> pieces{"distance", "strain", "min", "max",  "(",   ")",   "+", "-", "*",   "/",  "^",
                                        "?",        ":",      ",",   "<=",   "==",  "!",   "=", "1", "2.5", "e9", ".",
                                        " ",        "&&",     "||",  "sqrt", "_pi", "sum", "?", ":", "((",  "))"};
  Random random(1);
  const std::vector<double> values(quantities().size(), 0.5);
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string formula;
    for (std::uint64_t k = random.below(12); k > 0; --k)
      formula += random.chance(0.05) ? std::string(1, static_cast<char>(random.below(256)))
                                     : pieces[random.below(pieces.size())];
    try {
      const double score = Objective(formula).score(values);
      EXPECT_TRUE(std::isfinite(score) || score == worst_score) << formula;
      ++accepted;
    } catch (const ParameterError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << formula;
    }
  }
  EXPECT_GT(accepted, 100);
}

TEST(Objective, DeeplyNestedFormulasAreAcceptedOrRefused) {
  EXPECT_EQ(problem_of(std::string(450, '(') + "distance" + std::string(450, ')')), "");
  EXPECT_NE(problem_of(std::string(1000, '(')), "");
  EXPECT_NE(problem_of(std::string(1000, '-')), "");
}

TEST(Objective, KnowsWhichQuantitiesItUses) {
  const auto names = [](const std::string& formula) {
    std::vector<std::string> used;
    const Objective objective(formula);
    for (const std::size_t q : objective.uses()) used.emplace_back(quantities()[q].name);
    return used;
  };
  EXPECT_THAT(names("distance - 0.1 * work"), testing::UnorderedElementsAre("distance", "work"));
  EXPECT_THAT(names("height > 1 ? straightness : -strain"),
              testing::UnorderedElementsAre("height", "straightness", "strain"));
  EXPECT_THAT(names("2 + 2"), testing::IsEmpty());
}

// Where the mean force is proportional to the mean velocity, a distance is rounding.
TEST(Objective, DistancesMeanNothingWhereNoRobotCanMoveItself) {
  for (const char* formula : {"distance", "1 - cruise_speed", "work + speed_x"}) {
    const Objective objective(formula);
    EXPECT_THAT(why_meaningless(objective, OceanSimple{}), HasSubstr("no robot can move itself in ocean-simple"));
    EXPECT_THAT(why_meaningless(objective, environment_named("space")), HasSubstr("nothing to push against"));
    for (const char* world : {"ocean", "land", "water", "ocean-simple+ground", "space+ground"})
      EXPECT_EQ(why_meaningless(objective, environment_named(world)), "") << world;
  }
  EXPECT_EQ(why_meaningless(Objective("work - strain"), OceanSimple{}), "");
}

}  // namespace
}  // namespace mercury
