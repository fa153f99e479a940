// SPDX-License-Identifier: Apache-2.0
// Replaces cuda_bridge.cpp in a build without CUDA.
#include "app/video/position_bridge.h"

namespace mercury {

std::unique_ptr<PositionBridge> make_cuda_bridge(int) { throw NoInterop("this build has no CUDA"); }
int cuda_device_of_current_context() { return -1; }

}  // namespace mercury
