// SPDX-License-Identifier: Apache-2.0
// What failed CUDA calls mean for the user.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>

namespace mercury::cuda {

// One line that says what happened and what helps. `what` says what the call was for: "stepping".
std::string failure_text(cudaError_t error, const char* what);

// The line for an allocation that the current device has no room for.
std::string no_room_text(std::size_t bytes);

}  // namespace mercury::cuda
