// SPDX-License-Identifier: Apache-2.0
// Options derived from the parameters of the robot generators.
#include "app/options/generator_options.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "mercury/error.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

ParameterValues parsed(const std::vector<std::string>& arguments) {
  const CommandTree tree;
  GeneratorOptions options;
  options.add_to(tree.root());
  tree.parse(arguments);
  return options.values();
}

const GeneratorParameter& parameter(const std::string& kind, const std::string& name) {
  const std::vector<GeneratorParameter>& all = generator_named(kind).parameters;
  return *std::ranges::find(all, name, &GeneratorParameter::name);
}

TEST(GeneratorOptions, ReadEveryKindOfValue) {
  const ParameterValues values = parsed({"--patch", "3", "--edge=0.3", "--air", "0.25", "--symmetry", "none",
                                         "--hidden", "20,30", "--voxels", "3x2x2..4x4x5"});
  EXPECT_EQ(values.at("patch"), ParameterValue(std::int64_t{3}));
  EXPECT_EQ(values.at("edge"), ParameterValue(0.3f));
  EXPECT_EQ(values.at("air"), ParameterValue(0.25));
  EXPECT_EQ(values.at("symmetry"), ParameterValue("none"));
  EXPECT_EQ(values.at("hidden"), ParameterValue(std::vector{20, 30}));
  EXPECT_EQ(values.at("voxels"), (ParameterValue(SizeRange{{3, 2, 2}, {4, 4, 5}})));
  EXPECT_EQ(values.size(), 6u);
}

TEST(GeneratorOptions, DefaultsReadBackFromTheirText) {
  for (const Generator& generator : generators())
    for (const GeneratorParameter& one : generator.parameters)
      EXPECT_EQ(parameter_value_from(one, "--" + one.name, option_text(one.initial)), one.initial) << one.name;
}

TEST(GeneratorOptions, ListValuesThatDifferFromTheDefaults) {
  const ParameterValues values = parsed({"--air", "0.3", "--patch", "4", "--points", "100", "--edge", "0.7"});
  using Options = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(options_of(generator_named("voxel"), values), (Options{{"--edge", "0.7"}, {"--patch", "4"}}));
  EXPECT_EQ(options_of(generator_named("nn"), values), (Options{{"--points", "100"}}));
  EXPECT_THAT(options_of(generator_named("voxel"), {}), IsEmpty());
}

TEST(GeneratorOptions, RefuseTextsOfAnotherKind) {
  const auto refusal = [](const GeneratorParameter& one, const std::string& text) -> std::string {
    return mercury::refusal([&] { parameter_value_from(one, "--" + one.name, text); });
  };
  EXPECT_EQ(refusal(parameter("voxel", "air"), "thin"), "--air: \"thin\" is not accepted; give a number");
  EXPECT_EQ(refusal(parameter("voxel", "patch"), "1.5"), "--patch: \"1.5\" is not accepted; give a whole number");
  EXPECT_THAT(refusal(parameter("voxel", "symmetry"), "w"),
              HasSubstr("symmetry: \"w\" is not accepted; give none, x, y"));
  EXPECT_THAT(refusal(parameter("voxel", "voxels"), "3x3"), HasSubstr("give XxYxZ"));
  EXPECT_THAT(refusal(parameter("voxel", "voxels"), "3x3x3..2x3x3"), HasSubstr("must not be above the second"));
  EXPECT_EQ(refusal(parameter("voxel", "air"), "7"), "") << "ranges count only where a generator uses the value";
}

}  // namespace
}  // namespace mercury
