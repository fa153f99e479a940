// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <span>

#include "mercury/telemetry.h"

namespace mercury::python {

namespace nb = nanobind;

// One element per robot, a structured NumPy array; the fields are those of Telemetry.
nb::object telemetry_array(std::span<const Telemetry> telemetry);

}  // namespace mercury::python
