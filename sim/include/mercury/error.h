// SPDX-License-Identifier: Apache-2.0
// Errors in what the user gave, and errors of the machine.
#pragma once

#include <stdexcept>
#include <string>

namespace mercury {

// What the user gave cannot be used. what() is one line: where, what is wrong, what would be accepted. The program
// exits with status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  // `where` names the place, as in "/springs/7" or "eel.json: /springs/7" or "--record".
  InputError(const std::string& where, const std::string& what) : std::runtime_error(where + ": " + what) {}
};

// A parameter has a value that cannot be used. what() is "density: -1 is not accepted; give a finite number >= 0
// kg/m3". `parameter` is its C++ name; several are joined with ", ". A front end that spells parameters its own way
// replaces the name: the program prints "--density: -1 is ...".
class ParameterError : public InputError {
 public:
  ParameterError(const std::string& parameter, const std::string& problem)
      : InputError(parameter, problem), parameter_(parameter), problem_(problem) {}

  const std::string& parameter() const { return parameter_; }
  const std::string& problem() const { return problem_; }

 private:
  std::string parameter_, problem_;
};

// The machine lacks what was asked for (no GPU, out of device memory). The program exits with status 1.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Why the system could not use a file, by its error number (errno): "the disk is full".
std::string reason_of(int error);
// Whether such an error is one of the machine (a full disk, no memory, a device that fails) and not of what the user
// gave.
bool is_fault_of_machine(int error);

}  // namespace mercury
