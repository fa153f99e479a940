// SPDX-License-Identifier: Apache-2.0
#include "mercury/parameters.h"

#include <charconv>
#include <cmath>

#include "mercury/error.h"

namespace mercury {
namespace {

template <class Number>
std::string shown(Number value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

[[noreturn]] void refuse(std::string_view name, const std::string& value, const std::string& accepted,
                         std::string_view unit, const char* before_unit = " ") {
  throw ParameterError(std::string(name), value + " is not accepted; give " + accepted +
                                              (unit.empty() ? std::string() : before_unit + std::string(unit)));
}

template <class Number>
void check_number(std::string_view name, Number value, const Accepts& accepts, std::string_view unit) {
  if (!accepts(static_cast<double>(value))) refuse(name, shown(value), accepts.text(std::is_integral_v<Number>), unit);
}

}  // namespace

bool Accepts::operator()(double value) const {
  if (std::isnan(value) || (std::isinf(value) && !or_infinite)) return false;
  return (above_lowest ? value > lowest : value >= lowest) && (below_highest ? value < highest : value <= highest);
}

std::string Accepts::text(bool whole) const {
  const auto number = [whole](double end) {
    return whole ? std::to_string(static_cast<std::int64_t>(end)) : shown(end);
  };
  if (std::isfinite(highest))
    return below_highest ? "at least " + number(lowest) + " and below " + number(highest)
                         : number(lowest) + " to " + number(highest);
  if (whole && std::isfinite(lowest)) return number(lowest) + " or more";
  const std::string kind = whole ? "a whole number" : or_infinite ? "a number" : "a finite number";
  return std::isfinite(lowest) ? kind + (above_lowest ? " > " : " >= ") + number(lowest) : kind;
}

void check_value(std::string_view name, float value, const Accepts& accepts, std::string_view unit) {
  check_number(name, value, accepts, unit);
}
void check_value(std::string_view name, double value, const Accepts& accepts, std::string_view unit) {
  check_number(name, value, accepts, unit);
}
void check_value(std::string_view name, std::int64_t value, const Accepts& accepts, std::string_view unit) {
  check_number(name, value, accepts, unit);
}
void check_value(std::string_view name, std::uint64_t value, const Accepts& accepts, std::string_view unit) {
  check_number(name, value, accepts, unit);
}
void check_value(std::string_view name, const Vec3& value, const Accepts& accepts, std::string_view unit) {
  for (const float component : {value.x, value.y, value.z}) {
    if (accepts(static_cast<double>(component))) continue;
    std::string accepted = accepts.text(false);  // "a finite number >= 0"
    accepted = "three finite numbers" + accepted.substr(std::string_view("a finite number").size());
    refuse(name, shown(value.x) + "," + shown(value.y) + "," + shown(value.z), accepted, unit, " of ");
  }
}

}  // namespace mercury
