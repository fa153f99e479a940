// SPDX-License-Identifier: Apache-2.0
#include "mercury/error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace mercury {

std::string reason_of(int error) {
  switch (error) {
    case ENOSPC:
      return "the disk is full";
    case EDQUOT:
      return "the disk quota is used up";
    case EFBIG:
      return "the file grew beyond the size allowed here (ulimit -f)";
    default:
      return std::generic_category().message(error);
  }
}

bool is_fault_of_machine(int error) {
  constexpr std::array faults{ENOSPC, EDQUOT, EFBIG, EIO, ENOMEM, EMFILE, ENFILE};
  return std::ranges::find(faults, error) != faults.end();
}

}  // namespace mercury
