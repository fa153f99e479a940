// SPDX-License-Identifier: Apache-2.0
// What a source file of one instruction set includes after it has set HWY_TARGET. The equations stand between the
// marks of that instruction set, so that their templates are compiled for it; nothing may include them before.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <hwy/highway.h>

#include "mercury/configuration.h"
#include "mercury/host_device.h"
#include "mercury/material.h"
#include "mercury/vec3.h"

HWY_BEFORE_NAMESPACE();
#include "sim/physics/environments.h"
#include "sim/physics/fixed_point.h"
#include "sim/physics/integration.h"
#include "sim/physics/muscle.h"
#include "sim/physics/springs.h"
HWY_AFTER_NAMESPACE();

#include "sim/cpu/lockstep_stepper.h"
#include "sim/cpu/muscle_factors.h"
#include "sim/cpu/stepper.h"
