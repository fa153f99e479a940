// SPDX-License-Identifier: Apache-2.0
// Reads tables of a TOML file key by key. Errors name file and line.
#define TOML_EXCEPTIONS 1
#include "evolution/run_folder/run_file.h"

#include <toml++/toml.h>
#include <algorithm>
#include <array>
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

#include "evolution/run_folder/run_file_layout.h"
#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/number_text.h"
#include "mercury/robot_file.h"
#include "mercury/vec3.h"
#include "robots/bytes.h"
#include "robots/file/whole_file.h"

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
      if (const auto digits = node.is_string() ? parse_number<Whole>(**node.as_string()) : std::nullopt) {
        value = *digits;
        return;
      }
    if (!node.is_integer() || !std::in_range<Whole>(**node.as_integer()))
      wrong(key, node, std::is_unsigned_v<Whole> ? "a whole number of 0 or more" : "a whole number");
    value = static_cast<Whole>(**node.as_integer());
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

namespace {

// "evolution.seed=1" and so on, of everything that decides about the lineage.
void add_to_fingerprint(std::uint64_t& fingerprint, const std::string& path, const toml::node& node) {
  constexpr std::string_view may_change[] = {".program", ".evolution.generations", ".configuration.device",
                                             ".configuration.threads"};
  if (std::ranges::find(may_change, path) != std::end(may_change)) return;
  const auto add = [&](std::string_view value) {
    fingerprint = checksum_of(path, fingerprint);
    fingerprint = checksum_of("=", fingerprint);
    fingerprint = checksum_of(value, fingerprint);
    fingerprint = checksum_of("\n", fingerprint);
  };
  node.visit([&](const auto& it) {
    if constexpr (toml::is_table<decltype(it)>)
      for (const auto& [key, below] : it) add_to_fingerprint(fingerprint, path + "." + std::string(key.str()), below);
    else if constexpr (toml::is_array<decltype(it)>)
      for (std::size_t i = 0; i < it.size(); ++i)
        add_to_fingerprint(fingerprint, path + "[" + std::to_string(i) + "]", *it.get(i));
    else if constexpr (toml::is_string<decltype(it)>)
      add(std::string("\"").append(*it));
    else if constexpr (toml::is_integer<decltype(it)> || toml::is_boolean<decltype(it)>)
      add(std::to_string(*it));
    else if constexpr (toml::is_floating_point<decltype(it)>)
      add(shortest_text(*it) + "f");
  });
}

toml::table parse_toml(const std::filesystem::path& path, std::string_view text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    // "Error while parsing array: encountered end-of-file"
    std::string_view problem = error.description();
    if (const std::size_t colon = problem.find(": "); problem.starts_with("Error while") && colon != problem.npos)
      problem.remove_prefix(colon + 2);
    throw InputError(path.string() + ":" + std::to_string(error.source().begin.line),
                     "not TOML: " + printable(problem, 300));
  }
}

void check_format(const std::filesystem::path& path, const toml::table& table, RunFileReader& reader) {
  const toml::node* format = reader.find("format");
  if (!format || format->value_exact<std::string>() != "mercury-run")
    throw InputError(path.string(), "is not the file of a run: format = \"mercury-run\" is missing");
  int version = 0;
  reader.value("version", version);
  const toml::node& node = *table.get("version");
  if (version < 1) reader.fail(node, "version: expected 1 or more");
  if (version > run_file_version)
    reader.fail(node, "version " + std::to_string(version) + " is newer than this program, which reads up to version " +
                          std::to_string(run_file_version));
}

// Adds file and line to what validate() says of a parameter.
void check_values(const std::filesystem::path& path, const RunSettings& settings, const RunFileReader::Lines& lines) {
  try {
    validate(settings.evolution);
    check_parameters(settings.space.muscles);
    check_parameters(settings.space.growth);
  } catch (const ParameterError& error) {
    auto found = lines.find(error.parameter());
    if (found == lines.end()) found = lines.find(error.parameter() + "s");
    const std::string line = found == lines.end() ? "" : ":" + std::to_string(found->second);
    throw InputError(path.string() + line, printable(error.what(), 300));
  }
}

// `founder` returns the document of a founder by its file's name.
template <class Founder>
RunFile parse(const std::filesystem::path& folder, std::string_view text, const Founder& founder) {
  const std::filesystem::path path = folder / run_file_name;
  const toml::table table = parse_toml(path, text);
  RunFile run;
  run.settings.evolution.trials = TrialSettings{};  // what files of earlier versions mean
  RunFileReader::Lines lines;
  RunFileReader reader(path, table, {}, lines);
  check_format(path, table, reader);
  describe(reader, run);
  reader.finish();
  check_values(path, run.settings, lines);
  run.fingerprint = Fnv1a::empty;
  add_to_fingerprint(run.fingerprint, "", table);
  for (const std::string& name : run.founder_files) {
    const std::filesystem::path at = folder / founders_name / name;
    if (name.empty() || name != std::filesystem::path(name).filename() || name.starts_with('.'))
      throw InputError(path.string(), "founders: \"" + printable(name) + "\" is not the name of a file");
    const std::string document = founder(at);
    run.fingerprint = checksum_of(document, run.fingerprint);
    try {
      run.settings.space.founders.push_back(parse_robot(document, robot_format_of(at)));
    } catch (const InputError& error) {
      throw InputError(at.string(), printable(error.what(), 300));
    }
  }
  return run;
}

}  // namespace

RunFile read_run_file(const std::filesystem::path& folder) {
  return parse(folder, read_whole_file(folder / run_file_name), read_whole_file);
}

RunFile parse_run_file(const std::filesystem::path& folder, const RunFileTexts& texts) {
  std::size_t next = 0;
  return parse(folder, texts.run, [&](const std::filesystem::path&) { return texts.founders.at(next++); });
}

std::string with_generations(const std::filesystem::path& path, const std::string& text, int generations) {
  const toml::table table = parse_toml(path, text);
  const toml::node* node = table.at_path("evolution.generations").node();
  if (!node || !node->is_integer()) throw InputError(path.string(), "[evolution] lacks generations");
  const toml::source_region region = node->source();
  std::size_t at = 0;
  for (unsigned line = 1; line < region.begin.line; ++line) at = text.find('\n', at) + 1;
  const std::size_t line_end = std::min(text.find('\n', at), text.size());
  const std::size_t first = text.find_first_of("+-0123456789", text.find('=', at));
  if (first >= line_end) throw InputError(path.string(), "generations is not a number on a line of its own");
  const std::size_t last = std::min(text.find_first_not_of("+-_0123456789abcdefoxABCDEF", first), line_end);
  std::string changed = text.substr(0, first) + std::to_string(generations) + text.substr(last);
  if (parse_toml(path, changed).at_path("evolution.generations").value<int>() != generations)
    throw InputError(path.string(), "generations is not a number on a line of its own");
  return changed;
}

}  // namespace mercury
