// SPDX-License-Identifier: Apache-2.0
#include "app/options/option_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "mercury/number_text.h"

namespace mercury {

std::string option_of(std::string_view parameter) {
  if (parameter == "output") return "-o";
  if (parameter == "axes") return "--axis";  // given once per axis
  std::string option = "--";
  for (const char letter : parameter) {
    option += letter == '_' ? '-' : letter;
    if (option.ends_with(", ")) option += "--";
  }
  return option;
}

std::string switch_of(std::string_view parameter, bool is_on_by_default) {
  return option_of(is_on_by_default ? "no_" + std::string(parameter) : std::string(parameter));
}

template <class Number>
Number number_from(const std::string& option, std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const char* kind = std::is_floating_point_v<Number> ? "a number"
                     : std::is_unsigned_v<Number>     ? "a whole number of 0 or more"
                                                      : "a whole number";
  if (error == std::errc::result_out_of_range)
    throw InputError(option, fmt::format("\"{}\" is out of range; give {}", text, kind));
  if (error != std::errc{} || end != text.data() + text.size() || text.empty())
    throw InputError(option, fmt::format("\"{}\" is not accepted; give {}", text, kind));
  return value;
}

template double number_from<double>(const std::string&, std::string_view);
template float number_from<float>(const std::string&, std::string_view);
template int number_from<int>(const std::string&, std::string_view);
template std::int64_t number_from<std::int64_t>(const std::string&, std::string_view);
template std::uint64_t number_from<std::uint64_t>(const std::string&, std::string_view);

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t start = 0;;) {
    const std::size_t end = text.find(separator, start);
    parts.push_back(text.substr(start, end - start));
    if (end == std::string_view::npos) return parts;
    start = end + 1;
  }
}

std::vector<float> numbers_from(const std::string& option, std::string_view text, std::size_t count, const char* form) {
  const auto parts = split(text, ',');
  if (parts.size() != count) throw InputError(option, fmt::format("\"{}\" is not accepted; give {}", text, form));
  std::vector<float> numbers;
  for (const std::string_view part : parts) numbers.push_back(number_from<float>(option, part));
  return numbers;
}

Vec3 vector_from(const std::string& option, std::string_view text) {
  const auto numbers = numbers_from(option, text, 3, "three numbers, as in 0.1,0,-2");
  return {numbers[0], numbers[1], numbers[2]};
}

std::vector<int> sizes_from(const std::string& option, std::string_view text, std::size_t count, const char* form) {
  const auto parts = split(text, 'x');
  std::vector<int> sizes;
  for (const std::string_view part : parts)
    if (const auto size = parse_number<int>(part); size > 0) sizes.push_back(*size);
  if (sizes.size() != count || parts.size() != count)
    throw InputError(option, fmt::format("\"{}\" is not accepted; give {} in whole numbers above 0", text, form));
  return sizes;
}

Grid grid_from(const std::string& option, const std::string& text) {
  const auto sizes = sizes_from(option, text, 2, "COLUMNSxROWS");
  return {sizes[0], sizes[1]};
}

Option add_choice(const Command& app, const std::string& name, std::string& value, std::vector<std::string> choices,
                  const std::string& description) {
  const std::string form = fmt::format("{}", fmt::join(choices, "|"));
  return add_value(app, name, value, description, form,
                   [choices = std::move(choices)](const std::string& option, const std::string& text) {
                     if (std::find(choices.begin(), choices.end(), text) == choices.end())
                       throw InputError(option,
                                        fmt::format("\"{}\" is not accepted; give {}", text, fmt::join(choices, ", ")));
                     return text;
                   });
}

void require_positive(const std::string& option, double value, const std::string& unit) {
  if (!(std::isfinite(value) && value > 0))
    throw InputError(option, fmt::format("{} is not accepted; give a finite number > 0{}", value, unit));
}

}  // namespace mercury
