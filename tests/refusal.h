// SPDX-License-Identifier: Apache-2.0
// The message of a call that must refuse what it is given.
#pragma once

#include <string>

#include "mercury/error.h"

namespace mercury {

// What the InputError says that `call` throws; empty if it throws none.
std::string refusal(const auto& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace mercury
