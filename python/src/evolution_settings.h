// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include "mercury/evolution.h"

namespace mercury::python {

// The settings of a search among these genomes, from the keyword arguments of evolution.py; sets the environment of
// the genomes. Throws TypeError for a name that is none, InputError for a value that cannot be used.
EvolutionSettings settings_from(const nanobind::dict& given, GenomeSpaceRequest& space);

}  // namespace mercury::python
