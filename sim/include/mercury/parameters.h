// SPDX-License-Identifier: Apache-2.0
// Parameters described as data. A struct lists its parameters once, in a table beside its members:
//
//   struct Ocean {
//     float density = 1000;
//     ...
//     static constexpr std::tuple parameters{
//         Parameter("density", &Ocean::density, "kg/m3", Accepts::at_least_zero, {0, 2000}, "Density of the water"),
//         ...};
//   };
//
// Everything else is derived from the tables: validate(), the program's options with their help, TOML keys, JSON
// members, HDF5 attributes, the window's sliders and "Copy as command". The default is the member's own initializer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "mercury/vec3.h"

namespace mercury {

// The values that a parameter may have: finite ones in a range.
struct Accepts {
  double lowest = -std::numeric_limits<double>::infinity(), highest = std::numeric_limits<double>::infinity();
  bool above_lowest = false, below_highest = false;  // whether that end itself is refused
  bool or_infinite = false;                          // also takes infinity
  friend bool operator==(const Accepts&, const Accepts&) = default;

  static const Accepts any, at_least_zero, above_zero;
  static constexpr Accepts at_least(double low) { return {.lowest = low}; }
  static constexpr Accepts between(double low, double high) { return {.lowest = low, .highest = high}; }
  static constexpr Accepts share_below_one() { return {.lowest = 0, .highest = 1, .below_highest = true}; }

  bool operator()(double value) const;
  // "a finite number >= 0", "0 to 1", "at least 0 and below 1"; of whole numbers "0 or more".
  std::string text(bool whole) const;
};
inline constexpr Accepts Accepts::any{}, Accepts::at_least_zero{.lowest = 0},
    Accepts::above_zero{.lowest = 0, .above_lowest = true};

// The values that a slider offers. The parameter may accept others.
struct TypicalRange {
  float low = 0, high = 1;
  bool logarithmic = false;
};

// `Value` is double, float, a whole number, bool or Vec3.
template <class Struct, class Value>
struct Parameter {
  // Aliases, since nvcc rewrites a pointer to member with parentheses that g++ warns about.
  using Member = Value Struct::*;
  using Switch = bool Struct::*;

  std::string_view name;  // the member's name; the option of "drag_coefficient" is --drag-coefficient
  Member member;
  std::string_view unit;  // "kg/m3"; empty = none
  Accepts accepts = Accepts::any;
  TypicalRange typical;
  std::string_view help;                  // one line, without the default, the unit and a full stop
  Switch enabled_by = nullptr;            // the parameter has an effect only while this member is true
  bool takes_downward_magnitude = false;  // the option also takes one number g, for (0, 0, -g)
  std::string_view form;                  // of the option's value in its help, "0..1"; empty = from the unit
  std::string_view default_note;          // in place of the default in the option's help, "default: --population"

  constexpr Parameter(std::string_view name_, Value Struct::*member_, std::string_view unit_, Accepts accepts_,
                      TypicalRange typical_, std::string_view help_)
      : name(name_), member(member_), unit(unit_), accepts(accepts_), typical(typical_), help(help_) {}
  // A switch. If its default is true, the option is --no-NAME.
  constexpr Parameter(std::string_view name_, Value Struct::*member_, std::string_view help_)
      : name(name_), member(member_), help(help_) {
    static_assert(std::is_same_v<Value, bool>);
  }

  constexpr Parameter only_if(bool Struct::*condition) const {
    Parameter changed = *this;
    changed.enabled_by = condition;
    return changed;
  }
  constexpr Parameter or_downward_magnitude() const {
    Parameter changed = *this;
    changed.takes_downward_magnitude = true;
    return changed;
  }
  constexpr Parameter with_form(std::string_view shown) const {
    Parameter changed = *this;
    changed.form = shown;
    return changed;
  }
  constexpr Parameter with_default_note(std::string_view note) const {
    Parameter changed = *this;
    changed.default_note = note;
    return changed;
  }

  Value default_value() const { return Struct{}.*member; }
};

// Calls visit(parameter, value) for each parameter of a struct that has a table, in the table's order. `value` refers
// to the member of `values`.
template <class Struct, class Visit>
constexpr void for_each_parameter(Struct& values, Visit&& visit) {
  std::apply([&](const auto&... parameter) { (visit(parameter, values.*parameter.member), ...); },
             std::remove_const_t<Struct>::parameters);
}

// Throws ParameterError, "density: -1 is not accepted; give a finite number >= 0 kg/m3", for a value out of range.
void check_value(std::string_view name, float value, const Accepts& accepts, std::string_view unit);
void check_value(std::string_view name, double value, const Accepts& accepts, std::string_view unit);
void check_value(std::string_view name, std::int64_t value, const Accepts& accepts, std::string_view unit);
void check_value(std::string_view name, std::uint64_t value, const Accepts& accepts, std::string_view unit);
void check_value(std::string_view name, const Vec3& value, const Accepts& accepts, std::string_view unit);
inline void check_value(std::string_view name, int value, const Accepts& accepts, std::string_view unit) {
  check_value(name, std::int64_t{value}, accepts, unit);
}
inline void check_value(std::string_view, bool, const Accepts&, std::string_view) {}

// The same for each parameter of a struct that has a table.
template <class Struct>
void check_parameters(const Struct& values) {
  for_each_parameter(values, [](const auto& parameter, const auto& value) {
    check_value(parameter.name, value, parameter.accepts, parameter.unit);
  });
}

}  // namespace mercury
