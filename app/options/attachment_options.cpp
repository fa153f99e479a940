// SPDX-License-Identifier: Apache-2.0
#include "app/options/attachment_options.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "app/options/option_values.h"
#include "mercury/robot.h"

namespace mercury {
namespace {

constexpr const char* form = "ROBOT:MASS[:X,Y,Z:STIFFNESS]";
constexpr const char* drive_form = "ROBOT:ACTUATOR:U";
constexpr const char* neuron_form = "ROBOT:NEURON:VALUE";

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

std::string text_of(const HeldValue& held) { return fmt::format("{}:{}:{}", held.robot, held.name, held.value); }

namespace {

// `accepted`: what follows "give". `largest`: of the value, with either sign.
HeldValue held_value_from(const std::string& option, const std::string& text, const std::string& accepted,
                          float largest) {
  const auto refuse = [&] { throw InputError(option, fmt::format("\"{}\" is not accepted; give {}", text, accepted)); };
  const std::size_t first = text.find(':'), last = text.rfind(':');
  if (first == std::string::npos || last <= first + 1) refuse();
  HeldValue held;
  try {
    held.robot = number_from<std::uint64_t>(option, std::string_view(text).substr(0, first));
    held.value = number_from<float>(option, std::string_view(text).substr(last + 1));
  } catch (const InputError&) {
    refuse();
  }
  held.name = text.substr(first + 1, last - first - 1);
  if (!(std::abs(held.value) <= largest)) refuse();
  return held;
}

}  // namespace

HeldValue drive_from(const std::string& option, const std::string& text) {
  return held_value_from(
      option, text,
      fmt::format("{}, as in 0:tail:0.5 for the actuator tail of robot 0 and a drive from -1 to 1", drive_form), 1);
}

HeldValue neuron_from(const std::string& option, const std::string& text) {
  return held_value_from(
      option, text,
      fmt::format("{}, as in \"0:hidden 3:0\" for neuron 3 of the layer hidden of robot 0, which is 0 then",
                  neuron_form),
      std::numeric_limits<float>::max());
}

void AttachmentOptions::add_to(const Command& command) {
  command
      .add_list("--attach", attached_,
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
  command
      .add_list("--neuron", neurons_,
                "Hold a neuron of a robot's brain at a value, as the Brain panel does; 0 silences it; may be repeated")
      .one_value_each()
      .with_form(neuron_form)
      .in_group("Robots");
}

HeldParts AttachmentOptions::held() const {
  HeldParts held;
  for (const std::string& text : attached_) held.attached.push_back(attached_mass_from("--attach", text));
  for (const std::string& text : drives_) held.drives.push_back(drive_from("--drive", text));
  for (const std::string& text : neurons_) held.neurons.push_back(neuron_from("--neuron", text));
  return held;
}

}  // namespace mercury
