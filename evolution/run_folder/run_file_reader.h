// SPDX-License-Identifier: Apache-2.0
// Reads tables of a TOML file key by key. Errors name file and line.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/vec3.h"

namespace mercury {

// Text of a file in a message: one line that is not too long.
inline std::string printable(std::string_view text, std::size_t longest = 80) {
  std::string line(text.substr(0, longest));
  std::erase_if(line, [](char letter) { return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f; });
  return line;
}

// As run_file_layout.h wants it.
class RunFileReader {
 public:
  // Lines of keys, for errors in values that come to light later.
  using Lines = std::map<std::string, unsigned, std::less<>>;

  RunFileReader(const std::filesystem::path& path, const toml::table& table, std::string name, Lines& lines)
      : path_(path), table_(table), name_(std::move(name)), lines_(lines) {}

  template <class Value>
  void value(std::string_view key, Value& value, std::string_view = {}) {
    read(key, required(key), value);
  }
  template <class Value>
  void parameter(std::string_view key, Value& value, std::string_view = {}) {
    if (const toml::node* node = find(key)) read(key, *node, value);
  }
  template <class Value, class FromName>
  void named(std::string_view key, Value& value, FromName from_name) {
    const toml::node& node = required(key);
    std::string name;
    read(key, node, name);
    try {
      value = from_name(name);
    } catch (const InputError& error) {
      fail(node, printable(error.what(), 300));
    }
  }
  template <class Describe>
  void table(std::string_view key, Describe describe) {
    below(key, required(key), describe);
  }
  template <class List, class Describe>
  void tables(std::string_view key, List& list, Describe describe) {
    const toml::node* node = find(key);
    list.clear();
    if (!node) return;
    if (!node->is_array()) fail(*node, std::string("[[").append(key) + "]] is expected to be a list of tables");
    for (const toml::node& element : *node->as_array()) {
      auto& item = list.emplace_back();
      below(key, element, [&](RunFileReader& reader) { describe(reader, item); });
    }
  }
  void generator_values(std::string_view key, const std::string& kind, ParameterValues& values) {
    below(key, required(key), [&](RunFileReader& reader) {
      if (const Generator* generator = find_generator(kind)) {
        for (const GeneratorParameter& parameter : generator->parameters) reader.generator_value(parameter, values);
      } else {
        reader.unknown_values(values);
      }
    });
  }
  // Throws for keys that nobody asked for.
  void finish() const {
    for (const auto& [key, node] : table_)
      if (!used_.contains(key.str()))
        fail(node, std::string("\"").append(printable(key.str())).append("\" is not a key of ").append(title()));
  }
  [[noreturn]] void fail(const toml::node& node, const std::string& problem) const {
    throw InputError(path_.string() + ":" + std::to_string(node.source().begin.line), problem);
  }
  const toml::node* find(std::string_view key) {
    const auto found = table_.find(key);
    if (found == table_.end()) return nullptr;
    used_.emplace(key);
    lines_.emplace(key, found->second.source().begin.line);
    return &found->second;
  }

 private:
  std::string title() const { return name_.empty() ? "a run" : std::string("[").append(name_).append("]"); }

  const toml::node& required(std::string_view key) {
    if (const toml::node* node = find(key)) return *node;
    fail(table_, title() + " lacks " + std::string(key));
  }
  template <class Describe>
  void below(std::string_view key, const toml::node& node, Describe describe) {
    if (!node.is_table()) fail(node, std::string(key) + " is expected to be a table");
    RunFileReader reader(path_, *node.as_table(), name_.empty() ? std::string(key) : name_ + "." + std::string(key),
                         lines_);
    describe(reader);
    reader.finish();
  }
  [[noreturn]] void wrong(std::string_view key, const toml::node& node, const std::string& expected) const {
    fail(node, printable(key) + ": expected " + expected);
  }

  void read(std::string_view key, const toml::node& node, bool& value) const {
    if (!node.is_boolean()) wrong(key, node, "true or false");
    value = **node.as_boolean();
  }
  void read(std::string_view key, const toml::node& node, std::string& value) const {
    if (!node.is_string()) wrong(key, node, "text");
    value = **node.as_string();
  }
  void read(std::string_view key, const toml::node& node, double& value) const {
    if (!node.is_number()) wrong(key, node, "a number");
    value = *node.value<double>();
  }
  void read(std::string_view key, const toml::node& node, float& value) const {
    double number = 0;
    read(key, node, number);
    if (std::abs(number) > std::numeric_limits<float>::max() && number - number == 0)
      wrong(key, node, "a number in single precision");
    value = static_cast<float>(number);
  }
  template <class Whole>
  requires std::is_integral_v<Whole>
  void read(std::string_view key, const toml::node& node, Whole& value) const {
    if constexpr (std::is_unsigned_v<Whole>)
      if (node.is_string() && from_digits(**node.as_string(), value)) return;
    if (!node.is_integer() || !std::in_range<Whole>(**node.as_integer()))
      wrong(key, node, std::is_unsigned_v<Whole> ? "a whole number of 0 or more" : "a whole number");
    value = static_cast<Whole>(**node.as_integer());
  }
  template <class Whole>
  static bool from_digits(const std::string& digits, Whole& value) {
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    return result.ec == std::errc() && result.ptr == end;
  }
  template <class Element>
  void read(std::string_view key, const toml::node& node, std::vector<Element>& list) const {
    if (!node.is_array()) wrong(key, node, "a list");
    list.clear();
    for (const toml::node& element : *node.as_array()) read(key, element, list.emplace_back());
  }
  template <class Element, std::size_t size>
  void read(std::string_view key, const toml::node& node, std::array<Element, size>& list) const {
    if (!node.is_array() || node.as_array()->size() != size)
      wrong(key, node, "a list of " + std::to_string(size) + " numbers");
    for (std::size_t i = 0; i < size; ++i) read(key, *node.as_array()->get(i), list[i]);
  }
  void read(std::string_view key, const toml::node& node, Vec3& value) const {
    std::array<float, 3> parts{};
    read(key, node, parts);
    value = {parts[0], parts[1], parts[2]};
  }
  void read(std::string_view key, const toml::node& node, SizeRange& range) {
    below(key, node, [&](RunFileReader& reader) {
      reader.value("smallest", range.smallest);
      reader.value("largest", range.largest);
    });
  }

  void generator_value(const GeneratorParameter& parameter, ParameterValues& values) {
    const toml::node* node = find(parameter.name);
    if (!node) return;
    ParameterValue value = parameter.initial;
    std::visit([&](auto& kind) { read(parameter.name, *node, kind); }, value);
    try {
      check(parameter, value);
    } catch (const InputError& error) {
      fail(*node, printable(error.what(), 300));
    }
    values[parameter.name] = std::move(value);
  }
  // Of a genome kind that is not one of Mercury's generators.
  void unknown_values(ParameterValues& values) {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      const auto take = [&]<class Value>(Value value) {
        read(name, *find(name), value);
        values[name] = std::move(value);
      };
      if (node.is_integer())
        take(std::int64_t{});
      else if (node.is_floating_point())
        take(double{});
      else if (node.is_string())
        take(std::string{});
      else if (node.is_array())
        take(std::vector<int>{});
      else if (node.is_table())
        take(SizeRange{});
      else
        fail(node, printable(name) + " is of a kind that no parameter has");
    }
  }

  const std::filesystem::path& path_;
  const toml::table& table_;
  const std::string name_;
  Lines& lines_;
  std::set<std::string, std::less<>> used_;
};

}  // namespace mercury
