// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "mercury/import.h"

namespace mercury {

std::string to_toml(const ImportedSettings& settings, const ImportReport& report) {
  std::string file;
  for (const char letter : report.file) file += static_cast<unsigned char>(letter) < ' ' ? ' ' : letter;
  std::string text = fmt::format("# World of {}, for mercury run, render and view --config.\n", file);
  text += fmt::format("# 1 m of the file is {:.4g} m here, 1 s is {:.4g} s.\n", report.length_scale, report.time_scale);
  text += fmt::format("environment = \"{}\"\ngravity = [0, 0, {:.9g}]\nstiffness-scale = {:.9g}\n",
                      settings.environment, settings.gravity, settings.stiffness_scale);
  if (settings.environment == "land") {
    text += fmt::format("friction = {:.9g}\n", settings.friction);
    if (settings.self_collision)
      text += fmt::format("contact-stiffness = {:.9g}\n", settings.contact_stiffness);
    else
      text += "no-self-collision = true\n";
  } else if (settings.environment == "ocean") {
    text += fmt::format("drag-coefficient = {:.9g}\nlift-coefficient = {:.9g}\n", settings.drag_coefficient,
                        settings.lift_coefficient);
  } else {
    text += "point-drag = 0\n";
  }
  text += fmt::format("dt = {:.9g}\ndamping = {:.9g}\n", settings.dt, settings.damping);
  if (!settings.seconds && !settings.settle) return text;
  text += "\n[run]\n";
  if (settings.seconds) text += fmt::format("seconds = {:.9g}\n", *settings.seconds);
  if (settings.settle) text += fmt::format("settle = {:.9g}\n", *settings.settle);
  return text;
}

}  // namespace mercury
