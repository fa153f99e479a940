// SPDX-License-Identifier: Apache-2.0
#include "app/options/attachment_options.h"

#include <fmt/format.h>

#include <cmath>

#include "app/options/option_values.h"
#include "mercury/robot.h"

namespace mercury {
namespace {

constexpr const char* form = "ROBOT:MASS[:X,Y,Z:STIFFNESS]";
constexpr const char* drive_form = "ROBOT:ACTUATOR:U";

[[noreturn]] void refuse(const std::string& option, const std::string& text) {
  throw InputError(option, fmt::format("\"{}\" is not accepted; give {}, as in 0:12 for a pin, or 0:12:0,0.5,1:40 for "
                                       "a spring to a point [m] with a stiffness above 0 [N/m]",
                                       text, form));
}

}  // namespace

std::string text_of(const AttachedMass& attached) {
  const std::string mass = fmt::format("{}:{}", attached.robot, attached.mass);
  if (!attached.spring) return mass;
  const auto& [target, stiffness] = *attached.spring;
  return fmt::format("{}:{},{},{}:{}", mass, target.x, target.y, target.z, stiffness);
}

AttachedMass attached_mass_from(const std::string& option, const std::string& text) {
  const std::vector<std::string_view> parts = split(text, ':');
  if (parts.size() != 2 && parts.size() != 4) refuse(option, text);
  AttachedMass attached;
  try {
    attached.robot = number_from<std::uint64_t>(option, parts[0]);
    const auto mass = number_from<std::uint64_t>(option, parts[1]);
    if (mass >= max_masses) refuse(option, text);
    attached.mass = static_cast<std::uint16_t>(mass);
    if (parts.size() == 4) attached.spring = {vector_from(option, parts[2]), number_from<float>(option, parts[3])};
  } catch (const InputError&) {
    refuse(option, text);
  }
  if (attached.spring) {
    const auto& [target, stiffness] = *attached.spring;
    if (!std::isfinite(target.x) || !std::isfinite(target.y) || !std::isfinite(target.z) || !std::isfinite(stiffness) ||
        !(stiffness > 0))
      refuse(option, text);
  }
  return attached;
}

std::string text_of(const DrivenActuator& driven) {
  return fmt::format("{}:{}:{}", driven.robot, driven.actuator, driven.drive);
}

DrivenActuator driven_actuator_from(const std::string& option, const std::string& text) {
  const auto refuse = [&] {
    throw InputError(option, fmt::format("\"{}\" is not accepted; give {}, as in 0:tail:0.5 for the actuator tail of "
                                         "robot 0 and a drive from -1 to 1",
                                         text, drive_form));
  };
  const std::size_t first = text.find(':'), last = text.rfind(':');
  if (first == std::string::npos || last <= first + 1) refuse();
  DrivenActuator driven;
  try {
    driven.robot = number_from<std::uint64_t>(option, std::string_view(text).substr(0, first));
    driven.drive = number_from<float>(option, std::string_view(text).substr(last + 1));
  } catch (const InputError&) {
    refuse();
  }
  driven.actuator = text.substr(first + 1, last - first - 1);
  if (!(driven.drive >= -1 && driven.drive <= 1)) refuse();
  return driven;
}

void AttachmentOptions::add_to(const Command& command) {
  command
      .add_list("--attach", texts_,
                "Pin a mass of a robot, both counted from 0, or hold it by a spring; may be repeated")
      .one_value_each()
      .with_form(form)
      .in_group("Robots");
  command
      .add_list("--drive", drives_,
                "Drive an actuator of a robot by hand, -1 (shortest) to 1 (longest), as the Actuators panel does; may "
                "be repeated")
      .one_value_each()
      .with_form(drive_form)
      .in_group("Robots");
}

std::vector<DrivenActuator> AttachmentOptions::driven() const {
  std::vector<DrivenActuator> all;
  for (const std::string& text : drives_) all.push_back(driven_actuator_from("--drive", text));
  return all;
}

std::vector<AttachedMass> AttachmentOptions::attached() const {
  std::vector<AttachedMass> all;
  for (const std::string& text : texts_) all.push_back(attached_mass_from("--attach", text));
  return all;
}

}  // namespace mercury
