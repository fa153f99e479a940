// SPDX-License-Identifier: Apache-2.0
// What is held from the start: masses that are pinned or held by a spring (--attach, and the key `attach` of a scene),
// and actuators that are driven by hand (--drive, and `drive`).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "mercury/vec3.h"

namespace mercury {

// The end of a spring of rest length 0, in the robot's own frame.
struct AttachedSpring {
  Vec3 target;          // [m]
  float stiffness = 0;  // [N/m]
  friend bool operator==(const AttachedSpring&, const AttachedSpring&) = default;
};

struct AttachedMass {
  std::size_t robot = 0;  // its number in the scene, from 0
  std::uint16_t mass = 0;
  std::optional<AttachedSpring> spring;  // absent: a pin, which holds the mass where it starts
  friend bool operator==(const AttachedMass&, const AttachedMass&) = default;
};

// "3:12" for a pin, "3:12:0,0.5,1:40" for a spring to a point [m] with its stiffness [N/m].
std::string text_of(const AttachedMass& attached);
// Throws InputError.
AttachedMass attached_mass_from(const std::string& option, const std::string& text);

// An actuator that has this drive in place of its sine or brain.
struct DrivenActuator {
  std::size_t robot = 0;  // its number in the scene, from 0
  std::string actuator;   // its name
  float drive = 0;        // u in [-1, 1]
  friend bool operator==(const DrivenActuator&, const DrivenActuator&) = default;
};

// "0:tail:0.5".
std::string text_of(const DrivenActuator& driven);
// The name may have colons. Throws InputError.
DrivenActuator driven_actuator_from(const std::string& option, const std::string& text);

class AttachmentOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);
  // Throw InputError.
  std::vector<AttachedMass> attached() const;
  std::vector<DrivenActuator> driven() const;

 private:
  std::vector<std::string> texts_, drives_;
};

}  // namespace mercury
