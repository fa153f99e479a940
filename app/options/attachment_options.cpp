// SPDX-License-Identifier: Apache-2.0
#include "app/options/attachment_options.h"

#include <fmt/format.h>

#include <cmath>

#include "app/options/option_values.h"
#include "mercury/robot.h"

namespace mercury {
namespace {

constexpr const char* form = "ROBOT:MASS[:X,Y,Z:STIFFNESS]";

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

void AttachmentOptions::add_to(const Command& command) {
  command
      .add_list("--attach", texts_,
                "Pin a mass of a robot, both counted from 0, or hold it by a spring; may be repeated")
      .one_value_each()
      .with_form(form)
      .in_group("Robots");
}

std::vector<AttachedMass> AttachmentOptions::attached() const {
  std::vector<AttachedMass> all;
  for (const std::string& text : texts_) all.push_back(attached_mass_from("--attach", text));
  return all;
}

}  // namespace mercury
