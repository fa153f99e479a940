// SPDX-License-Identifier: Apache-2.0
// Numbers in tables of CSV, whose texts are mercury/csv.h's.
#pragma once

#include <string>

#include "mercury/csv.h"

namespace mercury {

// The shortest text that reads back as this number; empty if it is not finite, which programs read as missing.
std::string csv_number(double value);

}  // namespace mercury
