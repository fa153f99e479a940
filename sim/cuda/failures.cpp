// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/failures.h"

#include "mercury/host_memory.h"

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
  std::string text = "the GPU has no room for " + byte_text(bytes) + " more";
  if (cudaMemGetInfo(&free, &total) == cudaSuccess)
    text += "; " + byte_text(free) + " of its " + byte_text(total) + " are free";
  else
    (void)cudaGetLastError();
  return text + ": give it fewer or smaller robots, or end other programs that use it";
}

}  // namespace mercury::cuda
