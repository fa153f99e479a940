// SPDX-License-Identifier: Apache-2.0
// Fields of CSV lines (RFC 4180).
#pragma once

#include <string>

namespace mercury {

// A text, in quotes where the standard requires them.
std::string csv_field(const std::string& text);

// The shortest text that reads back as this number; empty if it is not finite, which programs read as missing.
std::string csv_number(double value);

}  // namespace mercury
