// SPDX-License-Identifier: Apache-2.0
// Command-line options for the parameters of the robot generators, derived from their descriptions
// (mercury/generator.h). The parameter `air` becomes the option --air.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/options/command.h"
#include "mercury/generator.h"

namespace mercury {

class GeneratorOptions {
 public:
  // Adds an option for each parameter of a generator, or of all generators. The object must outlive the command.
  void add_to(const Command& command, const Generator& generator);
  void add_to(const Command& command);
  // Adds those that all generators share: what bodies are made of.
  void add_bodies_to(const Command& command);

  // The values given. The generator that uses them checks their ranges.
  const ParameterValues& values() const { return values_; }

 private:
  void add(const Command& command, const GeneratorParameter& parameter, const std::string& group);

  ParameterValues values_;
};

// "voxel", "nn", ...
std::vector<std::string> names_of_kinds();

// The value as it is written on the command line: "0.3", "y", "64,64", "4x3x3..7x5x4".
std::string option_text(const ParameterValue& value);

// The value that a text stands for. Throws InputError(option, ...) for a text of another kind.
ParameterValue parameter_value_from(const GeneratorParameter& parameter, const std::string& option,
                                    const std::string& text);

// Options ("--air", "0.2") for the parameters of a generator whose values differ from the defaults.
std::vector<std::pair<std::string, std::string>> options_of(const Generator& generator, const ParameterValues& values);

}  // namespace mercury
