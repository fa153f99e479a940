// SPDX-License-Identifier: Apache-2.0
// Errors that the user can mend: what was given cannot be used.
#pragma once

#include <stdexcept>
#include <string>

namespace mercury {

// What the user gave cannot be used. what() is one line: what, where, what would be accepted.
// The program ends with exit status 2 on it.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  // `where` names the place, as in "/springs/7" or "eel.json: /springs/7" or "--dt".
  InputError(const std::string& where, const std::string& what) : std::runtime_error(where + ": " + what) {}
};

// The machine lacks what was asked for (no GPU, out of device memory). Exit status 1.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace mercury
