// SPDX-License-Identifier: Apache-2.0
#include "mercury/origin.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "mercury/error.h"
#include "mercury/number_text.h"
#include "robots/file/document.h"
#include "robots/origin_member.h"

namespace mercury {
namespace {

std::string text_of(const Robot& robot, const char* key) {
  if (robot.origin.empty()) return {};
  try {
    const auto member = nlohmann::json::parse(json_member(robot.origin, key), nullptr, false);
    return member.is_string() ? member.get<std::string>() : std::string();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

std::string kind_of(const Robot& robot) { return text_of(robot, "kind"); }
std::string environment_of(const Robot& robot) { return text_of(robot, "environment"); }

// The ancestry in a robot's origin.
namespace {

using Json = nlohmann::json;

constexpr const char* ancestry_key = "ancestry";
constexpr std::size_t most_parents = 16;
constexpr const char* spaces = " \t\r\n";

[[noreturn]] void refuse_ancestry(const std::string& place, const std::string& what) {
  throw InputError("/origin/ancestry" + place, what);
}

// The position after a JSON string that begins at `begin`.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      return i + 1;
  }
  return text.size();
}

// A JSON object's text without its members of this key, given in quotation marks. The rest is not parsed: the weights
// of a network are many, and they keep every digit this way.
std::string without_member(const std::string& object, const std::string& quoted) {
  std::string rest;
  std::size_t copied = 0;  // the text before is in `rest`, or left out
  int depth = 0;
  std::size_t member = 0;  // where the current member of the outermost object begins, with the comma before it
  bool is_wanted = false, at_key = false;
  for (std::size_t i = 0; i < object.size(); ++i) {
    const char c = object[i];
    if (c == '"') {
      const std::size_t end = end_of_string(object, i);
      if (at_key) is_wanted = object.compare(i, end - i, quoted) == 0;
      at_key = false;
      i = end - 1;
      continue;
    }
    if ((c == '{' || c == '[') && ++depth == 1) {
      at_key = true;
      member = i + 1;
    }
    if (c == '}' || c == ']') --depth;
    const bool next = c == ',' && depth == 1;
    if (is_wanted && (next || depth == 0)) {
      const bool was_first = object[member] != ',';
      rest.append(object, copied, member - copied);
      copied = was_first && next ? i + 1 : i;
      is_wanted = false;
    }
    if (next) {
      at_key = true;
      member = std::max(i, copied);
    }
  }
  return rest.append(object, copied);
}

std::string text_of(const Ancestry& ancestry) {
  std::string text = "{\"parents\":[";
  for (std::size_t i = 0; i < ancestry.parents.size(); ++i) {
    if (i > 0) text += ',';
    text += json_text(ancestry.parents[i]);
  }
  text += ']';
  const auto add = [&](const char* key, const std::string& value) { text += std::string(",\"") + key + "\":" + value; };
  if (ancestry.crossover_seed) add("crossover_seed", std::to_string(*ancestry.crossover_seed));
  if (ancestry.mutation_seed) add("mutation_seed", std::to_string(*ancestry.mutation_seed));
  if (ancestry.strength) add("strength", shortest_text(*ancestry.strength));
  if (ancestry.muscles) add("muscles", shortest_text(*ancestry.muscles));
  if (ancestry.generation) add("generation", std::to_string(*ancestry.generation));
  return text += '}';
}

std::optional<std::uint64_t> natural(const Json& ancestry, const char* key) {
  const auto found = ancestry.find(key);
  if (found == ancestry.end()) return std::nullopt;
  if (!found->is_number_unsigned()) refuse_ancestry(std::string("/") + key, "a whole number >= 0 is expected");
  return found->get<std::uint64_t>();
}

std::optional<double> strength(const Json& ancestry, const char* key) {
  const auto found = ancestry.find(key);
  if (found == ancestry.end()) return std::nullopt;
  if (!found->is_number() || !(found->get<double>() >= 0))
    refuse_ancestry(std::string("/") + key, "a number >= 0 is expected");
  return found->get<double>();
}

std::vector<std::string> parents_in(const Json& ancestry) {
  const auto found = ancestry.find("parents");
  if (found == ancestry.end()) refuse_ancestry("/parents", "is missing");
  if (!found->is_array()) refuse_ancestry("/parents", "an array of names is expected");
  if (found->size() > most_parents) refuse_ancestry("/parents", "at most 16 names are accepted");
  std::vector<std::string> parents;
  for (const Json& parent : *found) {
    if (!parent.is_string())
      refuse_ancestry(std::string("/parents/").append(std::to_string(parents.size())), "a name is expected");
    parents.push_back(parent.get<std::string>());
  }
  return parents;
}

}  // namespace

std::optional<nlohmann::json> origin_member(const Robot& robot, const char* key) {
  if (robot.origin.find(key) == std::string::npos) return std::nullopt;
  const std::size_t begin = robot.origin.find_first_not_of(spaces);
  if (robot.origin[begin] != '{') throw InputError("/origin", "a JSON object is expected");
  std::string text;
  try {
    text = json_member(robot.origin, key);
  } catch (const InputError&) {
    throw InputError("/origin", "a JSON object is expected");
  }
  return text.empty() ? std::nullopt : std::optional<Json>(Json::parse(text));
}

std::string with_origin_member(const std::string& origin, std::string_view key, const std::string& text) {
  const std::string quoted = "\"" + std::string(key) + "\"";
  std::string whole = without_member(origin.empty() ? std::string("{}") : origin, quoted);
  const std::size_t begin = whole.find_first_not_of(spaces), end = whole.find_last_not_of(spaces);
  if (begin == std::string::npos || begin == end || whole[begin] != '{' || whole[end] != '}')
    throw InputError("/origin", "a JSON object is expected");
  if (text.empty()) return whole;
  const bool is_empty = whole.find_first_not_of(spaces, begin + 1) == end;
  whole.resize(end);
  if (!is_empty) whole += ',';
  return whole.append(quoted).append(":").append(text).append("}");
}

std::optional<Ancestry> ancestry_of(const Robot& robot) {
  const std::optional<Json> found = origin_member(robot, ancestry_key);
  if (!found) return std::nullopt;
  if (!found->is_object()) refuse_ancestry("", "a JSON object is expected");
  return Ancestry{.parents = parents_in(*found),
                  .crossover_seed = natural(*found, "crossover_seed"),
                  .mutation_seed = natural(*found, "mutation_seed"),
                  .strength = strength(*found, "strength"),
                  .muscles = strength(*found, "muscles"),
                  .generation = natural(*found, "generation")};
}

std::string with_ancestry(const std::string& origin, const Ancestry& ancestry) {
  return with_origin_member(origin, ancestry_key, text_of(ancestry));
}

}  // namespace mercury
