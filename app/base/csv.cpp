// SPDX-License-Identifier: Apache-2.0
#include "app/base/csv.h"

#include <fmt/format.h>

#include <cmath>

namespace mercury {

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace mercury
