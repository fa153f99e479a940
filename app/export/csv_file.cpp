// SPDX-License-Identifier: Apache-2.0
// A table of a motion, a line per frame: the center of mass and its velocity, and of a robot with a brain what is
// recorded of its senses and neurons.
#include <algorithm>
#include <cmath>

#include "app/base/output_files.h"
#include "app/export/writers.h"
#include "mercury/brain.h"
#include "mercury/observables.h"
#include "mercury/robot.h"

namespace mercury {
namespace {

// Headings for columns, all different: the second of a name ends in " 2".
std::vector<std::string> headings(const char* kind, const std::vector<std::string>& names) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto before = std::count(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]);
    all.push_back(kind + names[i] + (before > 0 ? " " + std::to_string(before + 1) : ""));
  }
  return all;
}

}  // namespace

void write_csv(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
               const ExportChoices& choices) {
  OutputStreams files;
  OutputStream& file = files.add(path);
  const BrainLayout layout = motion.has_brain() ? brain_layout(robot.robot) : BrainLayout{};
  file.text("time [s],x [m],y [m],z [m],velocity x [m/s],velocity y [m/s],velocity z [m/s]");
  for (const std::string& name : headings("sense ", layout.senses)) file.print(",{}", csv_field(name));
  for (const std::string& name : headings("neuron ", layout.neurons)) file.print(",{}", csv_field(name));
  file.text("\n");
  for (std::size_t frame = 0; frame < motion.frames(); ++frame) {
    const Pose pose = motion.pose_with_velocities(frame);
    file.print("{}", pose.time);
    for (const double number : mean_over_masses(robot.robot, pose.positions)) file.print(",{}", csv_number(number));
    for (const double number : mean_over_masses(robot.robot, pose.velocities)) file.print(",{}", csv_number(number));
    for (const std::span<const float> numbers : {motion.senses(frame), motion.neurons(frame)})
      for (const float number : numbers)
        file.print(",{}", std::isfinite(number) ? fmt::format("{}", number) : std::string());
    file.text("\n");
    choices.watch(frame + 1, motion.frames());
  }
  files.keep();
}

}  // namespace mercury
