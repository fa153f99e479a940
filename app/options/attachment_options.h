// SPDX-License-Identifier: Apache-2.0
// What is held from the start: masses that are pinned or held by a spring (--attach, and the key `attach` of a scene),
// actuators that are driven by hand (--drive, and `drive`), and neurons (--neuron, and `neuron`).
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

// An actuator or a neuron that is held by hand.
struct HeldValue {
  std::size_t robot = 0;  // its number in the scene, from 0
  std::string name;       // of the actuator or the neuron
  float value = 0;        // u of an actuator, in [-1, 1]; of a neuron, any finite number
  friend bool operator==(const HeldValue&, const HeldValue&) = default;
};

// "0:tail:0.5".
std::string text_of(const HeldValue& held);
// The name may have colons. Throw InputError.
HeldValue drive_from(const std::string& option, const std::string& text);
HeldValue neuron_from(const std::string& option, const std::string& text);

struct HeldParts {
  std::vector<AttachedMass> attached;
  std::vector<HeldValue> drives;   // of actuators, in place of their sines and brains
  std::vector<HeldValue> neurons;  // have these values whatever they read
};

class AttachmentOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);
  // Throws InputError.
  HeldParts held() const;

 private:
  std::vector<std::string> attached_, drives_, neurons_;
};

}  // namespace mercury
