// SPDX-License-Identifier: Apache-2.0
// The source file of an instruction set includes this after it has set HWY_TARGET. The equations of sim/physics stand
// between the marks of that instruction set, so that their templates are compiled for it. Nothing may include them
// earlier: the include guards would keep them out here.
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

#include "sim/cpu/kernels/body_stepper.h"
#include "sim/cpu/kernels/lockstep_stepper.h"
#include "sim/cpu/kernels/muscle_factors.h"
