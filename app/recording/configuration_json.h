// SPDX-License-Identifier: Apache-2.0
// A configuration as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "mercury/configuration.h"

namespace mercury {

// Its members by the names of the program's options: {"device": "cpu", "threads": 0, "solver": "force", "dt": 0.001,
// "damping": 0.1, "environment": "ocean", "density": 1000, ...}; vectors as [x, y, z].
nlohmann::ordered_json json_of(const Configuration& configuration);

// The reverse: a parameter that is missing has its default. Throws InputError for what is no configuration.
Configuration configuration_from(const nlohmann::ordered_json& json);

// The number whose shortest decimal gives this float again: 0.2, not 0.20000000298023224.
double shortest(float value);

}  // namespace mercury
