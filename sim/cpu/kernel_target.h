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

#include "sim/configuration.h"
#include "sim/host_device.h"
#include "sim/material.h"
#include "sim/vec3.h"

HWY_BEFORE_NAMESPACE();
#include "sim/environments.h"
#include "sim/fixed_point.h"
#include "sim/integration.h"
#include "sim/muscle.h"
#include "sim/springs.h"
HWY_AFTER_NAMESPACE();

#include "sim/cpu/lockstep_stepper.h"
#include "sim/cpu/muscle_factors.h"
#include "sim/cpu/stepper.h"
