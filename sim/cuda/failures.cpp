// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/failures.h"

#include <cstdio>

namespace mercury::cuda {
namespace {

// After these the process can use the device no more; only a new process can.
bool loses_the_device(cudaError_t error) {
  switch (error) {
    case cudaErrorIllegalAddress:
    case cudaErrorMisalignedAddress:
    case cudaErrorInvalidAddressSpace:
    case cudaErrorIllegalInstruction:
    case cudaErrorInvalidPc:
    case cudaErrorHardwareStackError:
    case cudaErrorLaunchFailure:
    case cudaErrorLaunchTimeout:
    case cudaErrorAssert:
    case cudaErrorECCUncorrectable:
    case cudaErrorNvlinkUncorrectable:
    case cudaErrorContextIsDestroyed:
    case cudaErrorNoDevice:
    case cudaErrorUnknown:
      return true;
    default:
      return false;
  }
}

std::string size_text(std::size_t bytes) {
  char text[32];
  const double mebibytes = static_cast<double>(bytes) / (1 << 20);
  if (mebibytes < 1024)
    std::snprintf(text, sizeof text, "%.0f MiB", mebibytes);
  else
    std::snprintf(text, sizeof text, "%.1f GiB", mebibytes / 1024);
  return text;
}

}  // namespace

std::string failure_text(cudaError_t error, const char* what) {
  const std::string reason = cudaGetErrorString(error);
  if (loses_the_device(error))
    return std::string("the GPU failed while ") + what + " (" + reason +
           "): start the program again; nvidia-smi and the system's log show the state of the GPU";
  if (error == cudaErrorMemoryAllocation)
    return "the GPU has no memory left: other programs use it (nvidia-smi shows which); wait, "
           "or "
           "give another device";
  if (error == cudaErrorDevicesUnavailable)
    return "the GPU cannot be used now; another program may have it alone (nvidia-smi shows who uses it): wait, or "
           "give "
           "another device";
  if (error == cudaErrorInsufficientDriver || error == cudaErrorSystemDriverMismatch)
    return "the GPU's driver is too old (" + reason + "): install a newer one, or use the device \"cpu\"";
  return std::string("CUDA: ") + what + ": " + reason;
}

std::string no_room_text(std::size_t bytes) {
  std::size_t free = 0, total = 0;
  std::string text = "the GPU has no room for " + size_text(bytes) + " more";
  if (cudaMemGetInfo(&free, &total) == cudaSuccess)
    text += "; " + size_text(free) + " of its " + size_text(total) + " are free";
  else
    (void)cudaGetLastError();
  return text + ": give it fewer or smaller robots, or end other programs that use it";
}

}  // namespace mercury::cuda
