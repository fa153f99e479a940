// SPDX-License-Identifier: Apache-2.0
// Options that check their values while they are parsed. Every error names the option and says what is accepted.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "app/options/command.h"
#include "app/scene/group_layout.h"
#include "mercury/error.h"
#include "mercury/vec3.h"

namespace mercury {

// The option of a parameter that a library names: "--drag-coefficient" of "drag_coefficient"; also of several, joined
// with ", ". That of "output" is "-o", that of "axes" "--axis".
std::string option_of(std::string_view parameter);
// The option of a switch: "--no-self-collision" if it is on by default.
std::string switch_of(std::string_view parameter, bool is_on_by_default);

// The whole text as a number of that type. Throws InputError("--dt: \"fast\" is not a number").
template <class Number>
Number number_from(const std::string& option, std::string_view text);

// The parts of a text between separators; one part if there is no separator.
std::vector<std::string_view> split(std::string_view text, char separator);

// `count` numbers, separated by commas. Throws InputError, with `form` as what is accepted.
std::vector<float> numbers_from(const std::string& option, std::string_view text, std::size_t count, const char* form);

// "1,0,-2.5". Throws InputError.
Vec3 vector_from(const std::string& option, std::string_view text);

// "WxH" or "WxHxD": positive whole numbers. Throws InputError, with `form` as what is accepted: "WIDTHxHEIGHT".
std::vector<int> sizes_from(const std::string& option, std::string_view text, std::size_t count, const char* form);
// "COLUMNSxROWS".
Grid grid_from(const std::string& option, const std::string& text);

// An option with one value. If it is given twice, the last value counts. `name` may list several names: "-o,--output".
template <class Value, class Parse>
Option add_value(const Command& app, const std::string& name, Value& value, const std::string& description,
                 const std::string& form, Parse parse) {
  return app.add_option(
      name, [&value, name, parse](const std::string& text) { value = parse(name, text); }, description, form);
}

// An option with a number as value.
template <class Number>
Option add_number(const Command& app, const std::string& name, Number& value, const std::string& description,
                  const std::string& form) {
  return add_value(app, name, value, description, form, number_from<Number>)
      .as_number(!std::is_floating_point_v<Number>);
}
template <class Number>
Option add_number(const Command& app, const std::string& name, std::optional<Number>& value,
                  const std::string& description, const std::string& form) {
  return add_value(app, name, value, description, form, number_from<Number>)
      .as_number(!std::is_floating_point_v<Number>);
}

// An option with text as value.
inline Option add_text(const Command& app, const std::string& name, std::string& value, const std::string& description,
                       const std::string& form) {
  return add_value(app, name, value, description, form,
                   [](const std::string&, const std::string& text) { return text; });
}

// An option with one of several words as value.
Option add_choice(const Command& app, const std::string& name, std::string& value, std::vector<std::string> choices,
                  const std::string& description);

// Throws InputError("--fps: 0 is not accepted; give a number > 0 <unit>") unless it is finite and above 0.
void require_positive(const std::string& option, double value, const std::string& unit);

}  // namespace mercury
