// SPDX-License-Identifier: Apache-2.0
#include "app/scene/side_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <type_traits>

#include "mercury/error.h"
#include "mercury/number_text.h"

namespace mercury {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw ParameterError("compare", what); }

template <class Number>
Number number_from(const std::string& name, std::string_view text) {
  const auto value = parse_number<Number>(text);
  if (!value) refuse(fmt::format("{}: \"{}\" is not a number", name, text));
  return *value;
}

Vec3 vector_from(const std::string& name, std::string_view text) {
  std::array<float, 3> parts{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t colon = text.find(':');
    if ((colon == std::string_view::npos) != (i + 1 == parts.size()))
      refuse(fmt::format("{}: give three numbers with colons between them, as in 0.5:0:0", name));
    parts[i] = number_from<float>(name, text.substr(0, colon));
    text.remove_prefix(colon == std::string_view::npos ? text.size() : colon + 1);
  }
  return {parts[0], parts[1], parts[2]};
}

template <class Value>
void read(const std::string& name, const std::string& text, Value& value) {
  if constexpr (std::is_same_v<Value, bool>) {
    if (text != "on" && text != "off") refuse(fmt::format("{}: \"{}\" is not accepted; give on or off", name, text));
    value = text == "on";
  } else if constexpr (std::is_same_v<Value, Vec3>) {
    value = vector_from(name, text);
  } else {
    value = number_from<Value>(name, text);
  }
}

// Sets the parameter of that name. Returns false if the struct or environment has none.
template <class Values>
bool set_parameter(Values& values, const std::string& name, const std::string& text) {
  bool known = false;
  for_each_parameter(values, [&](const auto& parameter, auto& value) {
    if (parameter.name != name) return;
    read(name, text, value);
    known = true;
  });
  return known;
}

std::string known_names() {
  std::string names = "solver, environment";
  std::set<std::string_view> listed;
  const auto add = [&](const auto& parameter, const auto&) {
    if (listed.insert(parameter.name).second) names += fmt::format(", {}", parameter.name);
  };
  Configuration usual;
  for_each_parameter(usual, add);
  for (const EnvironmentPreset& preset : environment_presets) for_each_parameter(preset.environment, add);
  return names;
}

// Throws unless some configuration accepts the setting.
void check(const std::string& name, const std::string& value) {
  try {
    if (name == "solver") return (void)solver_named(value);
    if (name == "environment") return (void)environment_named(value);
    Configuration one;
    bool known = set_parameter(one, name, value);
    validate(one);
    for (const EnvironmentPreset& preset : environment_presets) {
      one.environment = preset.environment;
      known = set_parameter(one.environment, name, value) || known;
      validate(one);
    }
    if (!known) refuse(fmt::format("\"{}\" is not a setting; give some of {}", name, known_names()));
  } catch (const ParameterError& error) {
    if (error.parameter() == "compare") throw;
    refuse(error.what());
  }
}

std::string shown(double value) { return fmt::format("{:.4g}", value); }
std::string shown(float value) { return fmt::format("{:.4g}", value); }
std::string shown(bool value) { return value ? "on" : "off"; }
std::string shown(Vec3 value) { return fmt::format("({:.3g}, {:.3g}, {:.3g})", value.x, value.y, value.z); }

struct Texts {
  std::pair<std::string, std::string> of;
  void add(const std::string& first, const std::string& second) {
    of.first += (of.first.empty() ? "" : ", ") + first;
    of.second += (of.second.empty() ? "" : ", ") + second;
  }
};

template <class Parameter, class Value>
void compare(const Parameter& parameter, const Value& value, const Value& other, Texts& texts) {
  if (value == other) return;
  std::string label(parameter.name), unit(parameter.unit.empty() ? "" : fmt::format(" {}", parameter.unit));
  std::ranges::replace(label, '_', ' ');
  texts.add(fmt::format("{} {}{}", label, shown(value), unit), fmt::format("{} {}{}", label, shown(other), unit));
}

}  // namespace

SideDifference::SideDifference(const std::string& text) {
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(',', begin);
    const std::string setting = text.substr(begin, end - begin);
    const std::size_t sign = setting.find('=');
    if (sign == std::string::npos || sign + 1 == setting.size())
      refuse(fmt::format("\"{}\" is not accepted; give settings such as solver=xpbd or environment=land,dt=0.0005",
                         setting));
    set(setting.substr(0, sign), setting.substr(sign + 1));
  }
}

void SideDifference::set(const std::string& name, const std::string& value) {
  if (!value.empty()) check(name, value);
  const auto there = std::ranges::find(settings_, name, &std::pair<std::string, std::string>::first);
  if (there == settings_.end()) {
    if (!value.empty()) settings_.emplace_back(name, value);
  } else if (value.empty()) {
    settings_.erase(there);
  } else {
    there->second = value;
  }
}

std::string SideDifference::value(const std::string& name) const {
  const auto there = std::ranges::find(settings_, name, &std::pair<std::string, std::string>::first);
  return there == settings_.end() ? "" : there->second;
}

Configuration SideDifference::over(const Configuration& first) const {
  Configuration second = first;
  if (const std::string solver = value("solver"); !solver.empty()) second.solver = solver_named(solver);
  if (const std::string kind = value("environment"); !kind.empty() && kind != name_of(first.environment))
    second.environment = environment_named(kind);
  for (const auto& [name, value] : settings_)
    if (name != "solver" && name != "environment" && !set_parameter(second, name, value))
      set_parameter(second.environment, name, value);
  return second;
}

std::string SideDifference::text() const {
  std::string text;
  for (const auto& [name, value] : settings_) text += fmt::format("{}{}={}", text.empty() ? "" : ",", name, value);
  return text;
}

std::pair<std::string, std::string> differences(const Configuration& first, const Configuration& second) {
  Texts texts;
  const auto solver_text = [](Solver solver) { return solver == Solver::xpbd ? "XPBD" : "force solver"; };
  const bool alike = same_parts(first.environment, second.environment);
  if (!alike) texts.add(std::string(name_of(first.environment)), std::string(name_of(second.environment)));
  if (first.solver != second.solver) texts.add(solver_text(first.solver), solver_text(second.solver));
  for_each_parameter(first, [&](const auto& parameter, const auto& value) {
    compare(parameter, value, second.*parameter.member, texts);
  });
  if (alike)
    for_each_parameter_pair(first.environment, second.environment,
                            [&](const auto& parameter, const auto& a, const auto& b) {
                              compare(parameter, a.*parameter.member, b.*parameter.member, texts);
                            });
  return texts.of;
}

}  // namespace mercury
