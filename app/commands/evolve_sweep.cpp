// SPDX-License-Identifier: Apache-2.0
#include "app/commands/evolve_sweep.h"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "app/options/evolution_options.h"
#include "app/options/option_values.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr const char* usual_seeds = "1..10";
constexpr std::size_t most_runs = 10'000;

// "1..20" or "1,4,9"
std::vector<std::uint64_t> seeds_from(const std::string& text) {
  const auto number = [](std::string_view part) { return number_from<std::uint64_t>("--seeds", part); };
  std::vector<std::uint64_t> seeds;
  if (const std::size_t dots = text.find(".."); dots != std::string::npos) {
    const std::uint64_t first = number(std::string_view(text).substr(0, dots)),
                        last = number(std::string_view(text).substr(dots + 2));
    if (last < first || last - first >= most_runs)
      throw InputError("--seeds",
                       fmt::format("\"{}\" is not accepted; give FIRST..LAST, at most {} seeds", text, most_runs));
    for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
    return seeds;
  }
  for (const std::string_view part : split(text, ',')) seeds.push_back(number(part));
  if (std::set<std::uint64_t>(seeds.begin(), seeds.end()).size() < seeds.size())
    throw InputError("--seeds", fmt::format("\"{}\" is not accepted; a seed is there twice", text));
  return seeds;
}

using Values = std::map<std::string, std::string>;  // by option: "--algorithm"

struct Variant {
  std::string name;  // "algorithm=ga,population=64"; "all" if nothing varies
  Values values;
};

// Every combination, in the order that was given, the last option fastest.
std::vector<Variant> variants_from(const std::vector<std::string>& varied) {
  std::vector<Variant> variants(1);
  for (const std::string& one : varied) {
    const std::size_t sign = one.find('=');
    if (sign == 0 || sign == std::string::npos || sign + 1 == one.size())
      throw InputError("--vary", fmt::format("\"{}\" is not accepted; give OPTION=VALUE,VALUE", one));
    const std::string name = one.substr(0, sign), option = "--" + name;
    std::vector<Variant> more;
    for (const Variant& variant : variants) {
      if (variant.values.contains(option)) throw InputError("--vary", fmt::format("\"{}\" varies twice", name));
      for (const std::string_view value : split(std::string_view(one).substr(sign + 1), ',')) {
        if (value.empty()) throw InputError("--vary", fmt::format("\"{}\" is not accepted; a value is empty", one));
        Variant& added = more.emplace_back(variant);
        added.values[option] = value;
        added.name += fmt::format("{}{}={}", added.name.empty() ? "" : ",", name, value);
      }
    }
    variants = std::move(more);
  }
  if (variants.front().name.empty()) variants.front().name = "all";
  return variants;
}

// What a folder can be called anywhere.
std::string folder_name(std::string text) {
  constexpr std::string_view plain = "-_.,=+";
  for (char& c : text)
    if (!(c >= '0' && c <= '9') && !(c >= 'A' && c <= 'Z') && !(c >= 'a' && c <= 'z') &&
        plain.find(c) == std::string_view::npos)
      c = '_';
  return text.starts_with('.') ? "_" + text : text;
}

// The settings of a run with the options of the command, but for some values.
RunSettings settings_with(const Command& command, const Values& values, std::vector<std::string>& notes) {
  const CommandTree tree("evolve");
  EvolutionOptions run;
  run.add_to(tree.root());
  std::vector<std::string> words;
  for (const Option& option : command.options()) {
    const std::string name = "--" + option.name();
    if (!option.is_given() || option.is_positional() || values.contains(name) || !tree.root().find_option(name))
      continue;
    if (!option.takes_value()) words.push_back(name);
    for (const std::string& value : option.values())
      if (option.takes_value()) words.push_back(name + "=" + value);
  }
  for (const auto& [name, value] : values) {
    const auto option = tree.root().find_option(name);
    if (!option) throw InputError("--vary", fmt::format("\"{}\" is no option of a run", name.substr(2)));
    if (!option->takes_value() && value != "yes" && value != "no")
      throw InputError("--vary", fmt::format("\"{}={}\" is not accepted; give yes or no", name.substr(2), value));
    if (option->takes_value() || value == "yes") words.push_back(option->takes_value() ? name + "=" + value : name);
  }
  tree.parse(words);
  return run.settings(notes);
}

}  // namespace

void SweepOptions::add_to(const Command& command) {
  add_text(command, "--seeds", seeds_, "A sweep: a run per seed, as in 1..20 or 1,4,9", "FIRST..LAST")
      .in_group("Sweep");
  command
      .add_list("--vary", varied_,
                fmt::format("A sweep: a run per value and seed (default --seeds {}; yes and no of options without a "
                            "value); may be given several times",
                            usual_seeds))
      .one_value_each()
      .with_form("OPTION=VALUE,...")
      .in_group("Sweep");
}

std::vector<SweepOptions::Run> SweepOptions::runs(const Command& command, std::vector<std::string>& notes) const {
  if (command.is_given("--seed")) throw InputError("--seed", "not together with --seeds or --vary; give --seeds alone");
  const std::vector<std::uint64_t> seeds = seeds_from(seeds_.empty() ? usual_seeds : seeds_);
  std::vector<Variant> variants = variants_from(varied_);
  if (seeds.size() * variants.size() > most_runs)
    throw InputError("--vary",
                     fmt::format("makes {} runs; at most {} are accepted", seeds.size() * variants.size(), most_runs));
  std::set<std::string> folders;
  for (Variant& variant : variants)
    if (variant.values.contains("--seed") || !folders.insert(variant.name = folder_name(variant.name)).second)
      throw InputError("--vary", fmt::format("\"{}\" is not accepted; {}", variant.name,
                                             variant.values.contains("--seed") ? "give --seeds" : "it is there twice"));
  std::vector<Run> runs;
  for (const std::uint64_t seed : seeds)
    for (const Variant& variant : variants) {
      Values values = variant.values;
      values["--seed"] = std::to_string(seed);
      std::vector<std::string> own;
      runs.push_back(
          {std::filesystem::path(variant.name) / fmt::format("seed-{}", seed), settings_with(command, values, own)});
      if (runs.size() == 1) notes = std::move(own);
    }
  return runs;
}

}  // namespace mercury
