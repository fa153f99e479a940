// SPDX-License-Identifier: Apache-2.0
// Joins the parameters of a generator, which programs set by name, with the members of the plain struct that C++ users
// fill in. One table per generator; each row is a member and its description:
//
//   const ParameterTable<ShellOptions> table{
//       parameter(&ShellOptions::lobes,
//                 {.name = "lobes", .help = "Lobes of the rim", .accepts = Accepts::between(0, 12)}), ...};
//
// The struct's own default is the parameter's default.
#pragma once

#include <functional>
#include <type_traits>
#include <vector>

#include "mercury/generator.h"

namespace mercury {

template <class Options>
struct TableRow {
  GeneratorParameter description;
  std::function<ParameterValue(const Options&)> get;
  std::function<void(Options&, const ParameterValue&)> set;  // the value is of the parameter's kind
};

template <class Options>
using ParameterTable = std::vector<TableRow<Options>>;

template <class Options>
TableRow<Options> row_of(GeneratorParameter description, std::function<ParameterValue(const Options&)> get,
                         std::function<void(Options&, const ParameterValue&)> set) {
  description.initial = get(Options{});
  return {std::move(description), std::move(get), std::move(set)};
}

// A number or a list: the member is int, std::size_t, float, double or std::vector<int>.
template <class Options, class Value>
TableRow<Options> parameter(Value Options::*member, GeneratorParameter description) {
  using Kept = std::conditional_t<std::is_integral_v<Value>, std::int64_t, Value>;
  return row_of<Options>(
      std::move(description), [member](const Options& options) { return static_cast<Kept>(options.*member); },
      [member](Options& options, const ParameterValue& value) {
        options.*member = static_cast<Value>(std::get<Kept>(value));
      });
}

// One of several words: the member is an enumeration whose values 0, 1, ... stand for the words in their order.
template <class Options, class Value>
requires std::is_enum_v<Value> TableRow<Options> parameter(Value Options::*member, GeneratorParameter description) {
  const std::vector<std::string> words = description.words;
  return row_of<Options>(
      std::move(description),
      [member, words](const Options& options) { return words.at(static_cast<std::size_t>(options.*member)); },
      [member, words](Options& options, const ParameterValue& value) {
        const std::string& word = std::get<std::string>(value);
        for (std::size_t i = 0; i < words.size(); ++i)
          if (words[i] == word) options.*member = static_cast<Value>(i);
      });
}

// Sizes: two members.
template <class Options>
TableRow<Options> parameter(std::array<int, 3> Options::*smallest, std::array<int, 3> Options::*largest,
                            GeneratorParameter description) {
  return row_of<Options>(
      std::move(description),
      [=](const Options& options) {
        return SizeRange{options.*smallest, options.*largest};
      },
      [=](Options& options, const ParameterValue& value) {
        const auto& range = std::get<SizeRange>(value);
        options.*smallest = range.smallest;
        options.*largest = range.largest;
      });
}

template <class Options>
std::vector<GeneratorParameter> descriptions_in(const ParameterTable<Options>& table) {
  std::vector<GeneratorParameter> descriptions;
  for (const auto& row : table) descriptions.push_back(row.description);
  return descriptions;
}

// The struct that holds these values, each checked by itself. Throws ParameterError.
template <class Options>
Options options_from(const ParameterTable<Options>& table, const ParameterValues& values) {
  Options options;
  for (const auto& row : table) {
    const ParameterValue& value = value_of(values, row.description);
    check(row.description, value);
    row.set(options, value);
  }
  return options;
}

// Throws ParameterError for the first member that is out of its range.
template <class Options>
void check_each(const ParameterTable<Options>& table, const Options& options) {
  for (const auto& row : table) check(row.description, row.get(options));
}

// Fills in what of a generator follows from its table: the parameters, validate() and make(). `make` makes the index-th
// robot of a seed; Options has a member `environment`, and validate(Options) checks them.
template <class Options>
Generator with_parameters(Generator generator, const ParameterTable<Options>& table,
                          Robot (*make)(const Options&, std::uint64_t seed, std::uint64_t index)) {
  generator.parameters = descriptions_in(table);
  generator.validate = [&table](const ParameterValues& values) { validate(options_from(table, values)); };
  generator.make = [&table, make, own = generator.environment](const ParameterValues& values,
                                                               const std::string& environment, std::uint64_t seed,
                                                               std::uint64_t index) {
    Options options = options_from(table, values);
    options.environment = environment.empty() ? own : environment;
    return make(options, seed, index);
  };
  return generator;
}

}  // namespace mercury
