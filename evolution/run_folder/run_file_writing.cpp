// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <utility>

#include "evolution/run_folder/run_file.h"
#include "evolution/run_folder/run_file_layout.h"
#include "mercury/generator.h"
#include "mercury/names.h"
#include "mercury/number_text.h"
#include "mercury/quantity.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

// TOML takes a number with neither point nor exponent for a whole one.
std::string as_fraction(std::string text) {
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string toml_of(bool value) { return value ? "true" : "false"; }
std::string toml_of(const std::string& text) { return toml_text(text); }
std::string toml_of(double value) { return as_fraction(shortest_text(value)); }
std::string toml_of(float value) { return as_fraction(shortest_text(value)); }
std::string toml_of(int value) { return std::to_string(value); }
std::string toml_of(std::int64_t value) { return std::to_string(value); }
// TOML's whole numbers end at 2^63 - 1.
std::string toml_of(std::uint64_t value) {
  const std::string digits = std::to_string(value);
  return value >> 63 ? toml_text(digits) : digits;
}
template <class List>
std::string toml_of_list(const List& list) {
  std::string text = "[";
  for (const auto& element : list) {
    if (text.size() > 1) text.append(", ");
    text.append(toml_of(element));
  }
  text += ']';
  return text;
}
std::string toml_of(Vec3 v) { return toml_of_list(std::array{v.x, v.y, v.z}); }
std::string toml_of(const std::vector<std::string>& list) { return toml_of_list(list); }
std::string toml_of(const std::vector<int>& list) { return toml_of_list(list); }
std::string toml_of(const SizeRange& range) {
  std::string text = "{smallest = ";
  text.append(toml_of_list(range.smallest)).append(", largest = ").append(toml_of_list(range.largest)).append("}");
  return text;
}
std::string toml_of(const ParameterValue& value) {
  return std::visit([](const auto& kind) { return toml_of(kind); }, value);
}

class RunFileWriter {
 public:
  explicit RunFileWriter(std::string& text, std::string prefix = {}) : text_(text), prefix_(std::move(prefix)) {}

  template <class Value>
  void value(std::string_view key, const Value& value, std::string_view comment = {}) {
    line(key, toml_of(value), comment);
  }
  template <class Value>
  void parameter(std::string_view key, const Value& variable, std::string_view comment) {
    value(key, variable, comment);
  }
  template <class Value, class FromName>
  void named(std::string_view key, const Value& value, FromName) {
    line(key, toml_text(name_of(value)), {});
  }
  template <class Describe>
  void table(std::string_view key, Describe describe) {
    text_.append("\n[").append(prefix_).append(key).append("]\n");
    RunFileWriter below(text_, prefix_ + std::string(key) + ".");
    describe(below);
  }
  template <class List, class Describe>
  void tables(std::string_view key, const List& list, Describe describe) {
    for (const auto& element : list) {
      text_.append("\n[[").append(prefix_).append(key).append("]]\n");
      RunFileWriter below(text_, prefix_ + std::string(key) + ".");
      describe(below, element);
    }
  }
  // All parameters of a known generator, so that its defaults may change later.
  void generator_values(std::string_view key, const std::string& kind, const ParameterValues& values) {
    table(key, [&](RunFileWriter& below) {
      if (const Generator* generator = find_generator(kind)) {
        for (const GeneratorParameter& parameter : generator->parameters)
          below.value(parameter.name, value_of(values, parameter), parameter.unit);
      } else {
        for (const auto& [name, value] : values) below.value(name, value);
      }
    });
  }

 private:
  void line(std::string_view key, const std::string& value, std::string_view comment) {
    text_.append(key).append(" = ").append(value);
    if (!comment.empty()) text_.append("  # ").append(comment);
    text_ += '\n';
  }

  std::string& text_;
  std::string prefix_;
};

}  // namespace

std::string founder_file_name(std::size_t index) {
  char name[32];
  std::snprintf(name, sizeof name, "%04zu.json", index);
  return name;
}

RunFileTexts run_file_texts(const RunSettings& settings) {
  RunFile run{.settings = settings};
  for (const Quantity& quantity : quantities()) run.quantities.emplace_back(quantity.name);
  RunFileTexts texts;
  for (const Robot& founder : settings.space.founders) {
    run.founder_files.push_back(founder_file_name(texts.founders.size()));
    texts.founders.push_back(serialize_robot(founder, RobotFormat::json));
  }
  texts.run =
      "# A run of Mercury's evolution. `mercury evolve FOLDER --resume` goes on with it.\n"
      "# `generations`, `device` and `threads` may be changed; everything else belongs to the lineage.\n"
      "format = \"mercury-run\"\n"
      "version = " +
      std::to_string(run_file_version) + "\n";
  RunFileWriter writer(texts.run);
  describe(writer, std::as_const(run));
  return texts;
}

}  // namespace mercury
