// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "evolution/run_folder/checksum.h"
#include "evolution/run_folder/number_text.h"
#include "evolution/run_folder/run_file.h"
#include "evolution/run_folder/run_file_layout.h"
#include "evolution/run_folder/run_file_reader.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "robots/whole_file.h"

namespace mercury {
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
void check_values(const std::filesystem::path& path, const EvolutionSettings& settings,
                  const RunFileReader::Lines& lines) {
  try {
    validate(settings);
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
  RunFileReader::Lines lines;
  RunFileReader reader(path, table, {}, lines);
  check_format(path, table, reader);
  describe(reader, run);
  reader.finish();
  check_values(path, run.settings.evolution, lines);
  run.fingerprint = empty_checksum;
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
