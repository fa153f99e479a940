// SPDX-License-Identifier: Apache-2.0
// Every parameter in the tables of mercury/configuration.h reaches everything that is derived from the tables. New
// parameters are tested without an entry here.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/live/command_text.h"
#include "app/options/option_values.h"
#include "app/options/simulation_options.h"
#include "app/recording/configuration_json.h"

namespace mercury {
namespace {

// A value that the parameter accepts and that is not its default.
template <class Parameter>
float other(const Parameter& parameter, float) {
  return parameter.typical.low + 0.375f * (parameter.typical.high - parameter.typical.low);
}
template <class Parameter>
Vec3 other(const Parameter&, Vec3 usual) {
  return usual + Vec3{0.5f, -0.25f, 2};
}
template <class Parameter>
bool other(const Parameter&, bool usual) {
  return !usual;
}

// Calls test(parameter, configuration in which that parameter differs from its default).
template <class Test>
void for_each_change(const Test& test) {
  for (const char* name : {"ocean", "ocean-simple", "land", "ocean+ground+contacts", "space"}) {
    const Environment usual = environment_named(name);
    Configuration configuration{.environment = usual};
    for_each_parameter_pair(configuration.environment, usual,
                            [&](const auto& parameter, auto& part, const auto& usual_part) {
                              SCOPED_TRACE(std::string(name).append(1, ' ').append(parameter.name));
                              const auto& value = usual_part.*parameter.member;
                              part.*parameter.member = other(parameter, value);
                              EXPECT_NE(configuration.environment, usual) << "the default would pass for it";
                              test(parameter, configuration);
                              part.*parameter.member = value;
                            });
  }
}

Configuration parsed(const OptionValues& options) {
  const CommandTree tree;
  SimulationOptions simulation;
  simulation.add_to(tree.root());
  std::vector<std::string> arguments;
  for (const auto& [name, value] : options) arguments.push_back(value.empty() ? name : name + "=" + value);
  tree.parse(arguments);
  return simulation.configuration();
}

TEST(ParameterTables, AChangedParameterIsInTheCommandAndTheCommandRestoresIt) {
  for_each_change([](const auto&, const Configuration& changed) {
    const OptionValues options = options_of(changed);
    EXPECT_EQ(options.size(), 2u) << "--environment and the parameter";
    EXPECT_EQ(parsed(options), changed);
  });
}

TEST(ParameterTables, AParameterIsAMemberOfTheJsonAndIsReadFromIt) {
  for_each_change([](const auto& parameter, const Configuration& changed) {
    const auto json = json_of(changed);
    EXPECT_TRUE(json.contains(std::string(parameter.name)));
    EXPECT_EQ(configuration_from(json), changed);
  });
}

TEST(ParameterTables, ANegativeValueIsRefusedByName) {
  for (const char* name : {"ocean", "ocean-simple", "land", "ocean+ground+contacts", "space"}) {
    Configuration configuration{.environment = environment_named(name)};
    for_each_parameter(configuration.environment, [&]<class Value>(const auto& parameter, Value& value) {
      if constexpr (std::is_same_v<Value, float>) {
        const float usual = std::exchange(value, -1.0f);
        try {
          validate(configuration);
          EXPECT_EQ(parameter.accepts, Accepts::any) << parameter.name;
        } catch (const ParameterError& error) {
          EXPECT_EQ(error.parameter(), parameter.name);
        }
        value = usual;
      }
    });
  }
}

TEST(ParameterTables, TheFileFormatsPageNamesEveryParameter) {
  std::ifstream file(MERCURY_DOCS "/formats.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const auto expect_named = [&](const auto& parameter, const auto&) {
    EXPECT_THAT(page, testing::HasSubstr(std::string(1, '`').append(parameter.name).append("`")));
  };
  const Configuration configuration;
  for_each_parameter(configuration, expect_named);
  for_each_parameter(configuration.device, expect_named);
  for (const EnvironmentPreset& preset : environment_presets) for_each_parameter(preset.environment, expect_named);
}

TEST(OptionNames, AreDerivedFromParameters) {
  EXPECT_EQ(option_of("drag_coefficient"), "--drag-coefficient");
  EXPECT_EQ(option_of("muscle, tissue_share"), "--muscle, --tissue-share");
  EXPECT_EQ(switch_of("self_collision", true), "--no-self-collision");
  EXPECT_EQ(switch_of("self_collision", false), "--self-collision");
}

}  // namespace
}  // namespace mercury
