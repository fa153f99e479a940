// SPDX-License-Identifier: Apache-2.0
// Why and what a call refuses that must refuse what it is given.
#pragma once

#include <string>

#include "mercury/error.h"

namespace mercury {

// What the Error says that `call` throws; empty if it throws none.
template <class Error = InputError>
std::string refusal(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// The parameter that a call refuses; empty if it refuses none.
std::string refused_parameter(const auto& call) {
  try {
    call();
  } catch (const ParameterError& error) {
    return error.parameter();
  }
  return "";
}

}  // namespace mercury
