// SPDX-License-Identifier: Apache-2.0
#include "app/options/generator_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "app/options/option_values.h"

namespace mercury {
namespace {

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::toupper(letter); });
  return text;
}

// What stands after the option in a help text, as in "--edge M".
struct Form {
  const GeneratorParameter& parameter;

  std::string operator()(const std::string&) const { return fmt::format("{}", fmt::join(parameter.words, "|")); }
  std::string operator()(const std::vector<int>&) const { return "N,N,..."; }
  std::string operator()(const SizeRange&) const { return "XxYxZ[..XxYxZ]"; }
  std::string operator()(std::int64_t) const { return parameter.unit.empty() ? "N" : upper_case(parameter.unit); }
  std::string operator()(double) const {
    if (!parameter.unit.empty()) return upper_case(parameter.unit);
    const Accepts& accepts = parameter.accepts;
    return std::isfinite(accepts.highest) ? fmt::format("{}..{}", accepts.lowest, accepts.highest) : "X";
  }
};

std::string description_of(const GeneratorParameter& parameter) {
  const bool bounded =
      std::holds_alternative<std::int64_t>(parameter.initial) && std::isfinite(parameter.accepts.highest);
  return fmt::format("{}{} (default {})", parameter.help, bounded ? ", " + accepted_values(parameter) : "",
                     option_text(parameter.initial));
}

std::array<int, 3> size_from(const std::string& option, const std::string& text) {
  const auto sizes = sizes_from(option, text, 3, "XxYxZ, or a range as in 4x3x3..7x5x4,");
  return {sizes[0], sizes[1], sizes[2]};
}

// Reads a text as a value of the kind that the parameter's default has.
struct Reader {
  const std::string& option;
  const std::string& text;

  ParameterValue operator()(std::int64_t) const { return number_from<std::int64_t>(option, text); }
  ParameterValue operator()(float) const { return number_from<float>(option, text); }
  ParameterValue operator()(double) const { return number_from<double>(option, text); }
  ParameterValue operator()(const std::string&) const { return text; }
  ParameterValue operator()(const std::vector<int>&) const {
    std::vector<int> numbers;
    for (const std::string_view part : split(text, ',')) numbers.push_back(number_from<int>(option, part));
    return numbers;
  }
  ParameterValue operator()(const SizeRange&) const {
    const std::size_t dots = text.find("..");
    if (dots == std::string::npos) return SizeRange{size_from(option, text), size_from(option, text)};
    return SizeRange{size_from(option, text.substr(0, dots)), size_from(option, text.substr(dots + 2))};
  }
};

struct Writer {
  std::string operator()(const std::string& word) const { return word; }
  std::string operator()(const std::vector<int>& numbers) const { return fmt::format("{}", fmt::join(numbers, ",")); }
  std::string operator()(const SizeRange& sizes) const {
    return fmt::format("{}..{}", fmt::join(sizes.smallest, "x"), fmt::join(sizes.largest, "x"));
  }
  template <class Number>
  std::string operator()(Number number) const {
    return fmt::format("{}", number);
  }
};

}  // namespace

void GeneratorOptions::add(const Command& command, const GeneratorParameter& parameter, const std::string& group) {
  const std::string option = option_of(parameter.name);
  const Option added = command
                           .add_option(
                               option,
                               [this, &parameter, option](const std::string& text) {
                                 values_[parameter.name] = parameter_value_from(parameter, option, text);
                               },
                               description_of(parameter), std::visit(Form{parameter}, parameter.initial))
                           .in_group(group);
  const bool whole = std::holds_alternative<std::int64_t>(parameter.initial);
  const bool number =
      std::holds_alternative<float>(parameter.initial) || std::holds_alternative<double>(parameter.initial);
  if (whole || number) added.as_number(whole);
}

void GeneratorOptions::add_to(const Command& command, const Generator& generator) {
  for (const GeneratorParameter& parameter : generator.parameters)
    if (!parameter.shared) add(command, parameter, generator.title);
  add_bodies_to(command);
}

void GeneratorOptions::add_to(const Command& command) {
  for (const Generator& generator : generators()) add_to(command, generator);
}

void GeneratorOptions::add_bodies_to(const Command& command) {
  for (const GeneratorParameter& parameter : generators().front().parameters)
    if (parameter.shared && !command.find_option(option_of(parameter.name))) add(command, parameter, "Bodies");
}

std::vector<std::string> names_of_kinds() {
  std::vector<std::string> names;
  for (const Generator& generator : generators()) names.push_back(generator.kind);
  return names;
}

std::string option_text(const ParameterValue& value) { return std::visit(Writer{}, value); }

ParameterValue parameter_value_from(const GeneratorParameter& parameter, const std::string& option,
                                    const std::string& text) {
  ParameterValue value = std::visit(Reader{option, text}, parameter.initial);
  // Words and the order of sizes are part of how a value is written; ranges count only where the value is used.
  if (std::holds_alternative<std::string>(value) || std::holds_alternative<SizeRange>(value)) check(parameter, value);
  return value;
}

std::vector<std::pair<std::string, std::string>> options_of(const Generator& generator, const ParameterValues& values) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const GeneratorParameter& parameter : generator.parameters)
    if (const ParameterValue& value = value_of(values, parameter); value != parameter.initial)
      options.emplace_back(option_of(parameter.name), option_text(value));
  return options;
}

}  // namespace mercury
