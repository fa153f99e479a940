// SPDX-License-Identifier: Apache-2.0
// A configuration as JSON, and in words.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "mercury/configuration.h"

namespace mercury {

// Members have the names of the parameters (mercury/parameters.h): {"device": "cpu", "threads": 0, "solver": "force",
// "dt": 0.001, "damping": 0.1, "environment": "ocean", "density": 1000, ...}; vectors as [x, y, z].
nlohmann::ordered_json json_of(const Configuration& configuration);

// The reverse. A missing parameter has its default. Throws InputError if the document is not a configuration.
Configuration configuration_from(const nlohmann::ordered_json& json);

// "ocean, density 1000, ...", with the names of the options.
std::string environment_text(const Configuration& configuration);
// "force, dt 0.001 s, damping 0.1 1/s"
std::string solver_text(const Configuration& configuration);

// [x, y, z], each as by shortest() (mercury/number_text.h).
nlohmann::ordered_json json_of(Vec3 v);

}  // namespace mercury
