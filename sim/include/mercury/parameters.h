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

#include <string_view>
#include <tuple>
#include <type_traits>

namespace mercury {

// The values that a parameter may have. All must be finite.
enum class Accepts { any, at_least_zero, above_zero };

// The values that a slider offers. The parameter may accept others.
struct TypicalRange {
  float low = 0, high = 1;
  bool logarithmic = false;
};

// `Value` is double, float, int, bool or Vec3.
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

  Value default_value() const { return Struct{}.*member; }
};

// Calls visit(parameter, value) for each parameter of a struct that has a table, in the table's order. `value` refers
// to the member of `values`.
template <class Struct, class Visit>
constexpr void for_each_parameter(Struct& values, Visit&& visit) {
  std::apply([&](const auto&... parameter) { (visit(parameter, values.*parameter.member), ...); },
             std::remove_const_t<Struct>::parameters);
}

}  // namespace mercury
