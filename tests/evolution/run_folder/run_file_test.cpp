// SPDX-License-Identifier: Apache-2.0
// run.toml: every setting reads back bit for bit; what cannot be used is refused with file and line.
#include "evolution/run_folder/run_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "mercury/random_voxel.h"
#include "tests/evolution/run_folder/test_run.h"

namespace mercury {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

RunFile through_text(const RunSettings& settings) { return parse_run_file("RUN", run_file_texts(settings)); }

// Numbers with many digits in every place.
RunSettings odd_settings() {
  RunSettings settings{.program = "Mercury 0.3.0 \"odd\" \\ \n"};
  EvolutionSettings& evolution = settings.evolution;
  evolution.algorithm = {.name = "map-elites",
                         .population = 77,
                         .tournament = 3,
                         .elites = 1.0 / 3,
                         .crossover = 0.1 + 0.2,
                         .axes = {{.quantity = "size", .lowest = -0.0, .highest = 1e-300, .cells = 7},
                                  {.quantity = "distance", .lowest = -1e300, .highest = M_PI, .cells = 8}}};
  evolution.objectives = {"distance - 0.1 * speed"};
  evolution.trials = {.seconds = 10.0 / 3, .settle = 0.1, .trials = 3, .noise = 0.1, .damage = 0.01, .strain_limit = 7};
  evolution.configuration = {.dt = 1e-3 / 3, .damping = 1.0 / 7, .solver = Solver::xpbd};
  evolution.configuration.environment = Land{
      .gravity = {0.1f, -1.0f / 3, -9.81f}, .friction = 0.7f, .self_collision = false, .stiffness_scale = 16777215};
  evolution.configuration.device = device_named("cuda:all");
  evolution.configuration.device.threads = 3;
  evolution.children = 99;
  evolution.generations = 12345;
  evolution.mutation = std::nextafter(1.0, 2.0);
  evolution.seed = std::numeric_limits<std::uint64_t>::max();
  settings.space.kind = "voxel";
  settings.space.environment = "land";
  settings.space.genes = Genes::both;
  return settings;
}

TEST(RunFile, EverySettingReadsBackBitForBit) {
  const RunSettings written = odd_settings();
  const RunSettings read = through_text(written).settings;
  const EvolutionSettings &a = written.evolution, &b = read.evolution;
  EXPECT_EQ(a.algorithm.name, b.algorithm.name);
  EXPECT_EQ(a.algorithm.population, b.algorithm.population);
  EXPECT_EQ(a.algorithm.tournament, b.algorithm.tournament);
  EXPECT_EQ(a.algorithm.elites, b.algorithm.elites);
  EXPECT_EQ(a.algorithm.crossover, b.algorithm.crossover);
  EXPECT_EQ(a.algorithm.axes, b.algorithm.axes);
  EXPECT_TRUE(std::signbit(b.algorithm.axes[0].lowest));
  EXPECT_EQ(a.objectives, b.objectives);
  EXPECT_EQ(a.trials, b.trials);
  EXPECT_EQ(a.configuration, b.configuration);
  EXPECT_EQ(a.children, b.children);
  EXPECT_EQ(a.generations, b.generations);
  EXPECT_EQ(a.mutation, b.mutation);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(written.space.kind, read.space.kind);
  EXPECT_EQ(written.space.environment, read.space.environment);
  EXPECT_EQ(written.space.genes, read.space.genes);
  EXPECT_EQ(written.program, read.program);
}

TEST(RunFile, RandomNumbersReadBackBitForBit) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    RunSettings settings = test_settings();
    Ocean ocean;
    const auto finite = [&] {
      float value;
      do value = std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
      while (!std::isfinite(value));
      return value;
    };
    ocean.flow = {finite(), finite(), finite()};
    ocean.density = std::abs(finite());
    settings.evolution.configuration.environment = ocean;
    settings.evolution.configuration.environment.ground = Plane{std::abs(finite())};
    double mutation;
    do mutation = std::abs(std::bit_cast<double>(random.bits()));
    while (!std::isfinite(mutation) || mutation == 0);
    settings.evolution.mutation = mutation;
    settings.evolution.seed = random.bits();
    const EvolutionSettings read = through_text(settings).settings.evolution;
    ASSERT_EQ(read.configuration, settings.evolution.configuration);
    ASSERT_EQ(read.mutation, mutation);
    ASSERT_EQ(read.seed, settings.evolution.seed);
  }
}

TEST(RunFile, ValuesOfGeneratorsReadBackInTheirKind) {
  RunSettings settings = test_settings();
  for (const Generator& generator : generators()) {
    settings.space.kind = generator.kind;
    settings.space.values = {};
    const ParameterValues defaults = through_text(settings).settings.space.values;
    EXPECT_EQ(defaults.size(), generator.parameters.size());
    for (const GeneratorParameter& parameter : generator.parameters) {
      EXPECT_EQ(defaults.at(parameter.name), parameter.initial) << parameter.name;
      settings.space.values[parameter.name] = parameter.initial;
    }
    EXPECT_EQ(through_text(settings).settings.space.values, settings.space.values);
  }
  settings.space.kind = "a kind of the user's own";
  settings.space.values = {{"whole", std::int64_t{-3}},
                           {"fraction", 0.1},
                           {"word", std::string("x")},
                           {"list", std::vector<int>{3, -4}},
                           {"sizes", SizeRange{{1, 2, 3}, {4, 5, 6}}}};
  EXPECT_EQ(through_text(settings).settings.space.values, settings.space.values);
}

TEST(RunFile, FoundersKeepTheirOrder) {
  RunSettings settings = test_settings();
  for (std::uint64_t seed = 0; seed < 3; ++seed) settings.space.founders.push_back(random_voxel_robot({}, 5 - seed));
  settings.space.founders[1].name = "";
  EXPECT_EQ(through_text(settings).settings.space.founders, settings.space.founders);
}

TEST(RunFile, FingerprintIgnoresWhatMayChange) {
  const RunSettings settings = odd_settings();
  RunSettings changed = settings;
  changed.program = "another";
  changed.evolution.generations = 1;
  changed.evolution.configuration.device = {};
  EXPECT_EQ(through_text(changed).fingerprint, through_text(settings).fingerprint);
  changed.evolution.seed = 2;
  EXPECT_NE(through_text(changed).fingerprint, through_text(settings).fingerprint);
}

TEST(RunFile, FingerprintKnowsTheFounders) {
  RunSettings a = test_settings(), b = test_settings();
  a.space.founders = {random_voxel_robot({}, 1)};
  b.space.founders = {random_voxel_robot({}, 2)};
  EXPECT_NE(through_text(a).fingerprint, through_text(b).fingerprint);
}

TEST(RunFile, GenerationsCanBeReplacedInTheText) {
  const RunFileTexts texts = run_file_texts(odd_settings());
  RunFileTexts changed = texts;
  changed.run = with_generations("RUN/run.toml", "# a note of the user\n" + texts.run, 7);
  EXPECT_TRUE(changed.run.starts_with("# a note of the user\n"));
  const RunFile read = parse_run_file("RUN", changed);
  EXPECT_EQ(read.settings.evolution.generations, 7);
  EXPECT_EQ(read.fingerprint, parse_run_file("RUN", texts).fingerprint);
}

TEST(RunFile, EarlierVersionsMayLackAParameter) {
  RunFileTexts texts = run_file_texts(test_settings());
  const std::size_t at = texts.run.find("\nstrain_limit");
  texts.run.erase(at, texts.run.find('\n', at + 1) - at);
  EXPECT_EQ(parse_run_file("RUN", texts).settings.evolution.trials.strain_limit, TrialSettings{}.strain_limit);
}

TEST(RunFile, HasEveryParameterOfTheTables) {
  const std::string text = run_file_texts(test_settings()).run;
  const auto is_there = [&](const auto& parameter, const auto&) {
    EXPECT_THAT(text, HasSubstr("\n" + std::string(parameter.name) + " = ")) << parameter.name;
  };
  const EvolutionSettings settings;
  for_each_parameter(settings, is_there);
  for_each_parameter(settings.algorithm, is_there);
  for_each_parameter(settings.trials, is_there);
}

// A line of the test run is replaced.
std::string error_with(const std::string& line, const std::string& replacement) {
  RunFileTexts texts = run_file_texts(test_settings());
  const std::size_t at = texts.run.find("\n" + line);
  EXPECT_NE(at, std::string::npos) << line;
  texts.run.replace(at + 1, texts.run.find('\n', at + 1) - at - 1, replacement);
  return error_of([&] { parse_run_file("RUN", texts); });
}

unsigned line_of(const std::string& line) {
  const std::string text = run_file_texts(test_settings()).run;
  return 1 + static_cast<unsigned>(
                 std::count(text.begin(), text.begin() + 1 + static_cast<long>(text.find("\n" + line)), '\n'));
}

TEST(RunFile, ErrorsNameFileAndLine) {
  const std::string at = "RUN/run.toml:";
  const auto place = [&](const std::string& line) { return at + std::to_string(line_of(line)) + ": "; };
  EXPECT_EQ(error_with("seed", "seed = -1"), place("seed") + "seed: expected a whole number of 0 or more");
  EXPECT_EQ(error_with("seed", "seed = 1.5"), place("seed") + "seed: expected a whole number of 0 or more");
  EXPECT_EQ(error_with("seed", "sead = 1"), place("seed") + "\"sead\" is not a key of [evolution]");
  EXPECT_EQ(error_with("seed", "seed = 1\nsalt = 2"),
            at + std::to_string(line_of("seed") + 1) + ": \"salt\" is not a key of [evolution]");
  EXPECT_EQ(error_with("racing", "racing = 1"), place("racing") + "racing: expected true or false");
  EXPECT_EQ(error_with("flow", "flow = [1, 2]"), place("flow") + "flow: expected a list of 3 numbers");
  EXPECT_THAT(error_with("solver", "solver = \"euler\""), HasSubstr(place("solver")));
  EXPECT_THAT(error_with("population", "population = 0"), HasSubstr(place("population")));
  EXPECT_THAT(error_with("objectives", "objectives = [\"distanse\"]"), HasSubstr(place("objectives")));
  EXPECT_THAT(error_with("seed", "seed = = 1"), HasSubstr(place("seed")));
  EXPECT_EQ(error_with("version", "version = 3"),
            place("version") + "version 3 is newer than this program, which reads up to version 2");
  EXPECT_THAT(error_with("format", "format = \"x\""), HasSubstr("RUN/run.toml"));
  EXPECT_THAT(error_with("founders", "founders = [\"../../etc/passwd\"]"), EndsWith("is not the name of a file"));
}

}  // namespace
}  // namespace mercury
