// SPDX-License-Identifier: Apache-2.0
#include <hwy/detect_targets.h>
#undef HWY_TARGET
#define HWY_TARGET HWY_EMU128

#include "sim/cpu/kernels/kernel_target.h"

#include "sim/cpu/kernels/kernel.h"
#include "sim/cpu/kernels/spring_measures.h"

namespace mercury::cpu {

const Kernel portable_kernel{"portable",
                             HWY_NAMESPACE::lane_count,
                             HWY_NAMESPACE::fill_factors,
                             HWY_NAMESPACE::measure_springs,
                             HWY_NAMESPACE::looks_up_one_by_one,
                             HWY_NAMESPACE::advance,
                             HWY_NAMESPACE::advance_group};

}  // namespace mercury::cpu
