// SPDX-License-Identifier: Apache-2.0
// Values from Python, checked. Errors name the parameter: "count: must be a whole number, not str". A value of the
// wrong type throws TypeError, one that cannot be used InputError.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace mercury::python {

namespace nb = nanobind;

// Throws TypeError: "count: must be a whole number, not str".
[[noreturn]] void refuse_type(const std::string& parameter, const std::string& wanted, nb::handle given);

// A whole number: an int, or what has __index__, such as NumPy's integers. A bool is none.
std::int64_t whole_from(const std::string& parameter, nb::handle value,
                        std::int64_t lowest = std::numeric_limits<std::int64_t>::min(),
                        std::int64_t highest = std::numeric_limits<std::int64_t>::max());
// A whole number of 0 to 2^64 - 1.
std::uint64_t seed_from(const std::string& parameter, nb::handle value);
// A number: an int, a float, or what has __float__, such as NumPy's numbers. A text or a bool is none.
double number_from(const std::string& parameter, nb::handle value);
bool bool_from(const std::string& parameter, nb::handle value);
std::string text_from(const std::string& parameter, nb::handle value);
std::filesystem::path path_from(const std::string& parameter, nb::handle value);  // str or os.PathLike

}  // namespace mercury::python
