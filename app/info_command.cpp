// mercury info: what a robot file or trajectory holds, or what this machine can do.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/configuration_json.h"
#include "app/group_layout.h"
#include "app/machine.h"
#include "app/option_values.h"
#include "app/trajectory_layout.h"
#include "app/trajectory_reader.h"
#include "app/version.h"
#include "robots/file.h"

namespace mercury {
namespace {

struct InfoOptions {
  std::vector<std::string> paths;
  std::string ffmpeg, config;
};

std::string material_name(const Robot& robot, MaterialId id) {
  if (id < robot.material_names.size()) return robot.material_names[id];
  return robot.materials.empty() ? default_material_name(id) : fmt::format("material {}", id);
}

// "muscle 3 (120), bone (14), and 7 more", the most used first.
std::string materials_used(const Robot& robot) {
  constexpr std::size_t shown = 5;
  std::array<std::size_t, max_materials> uses{};
  for (const Spring& spring : robot.springs) ++uses[spring.material];
  std::vector<std::size_t> ids;
  for (std::size_t id = 0; id < uses.size(); ++id)
    if (uses[id] > 0) ids.push_back(id);
  std::stable_sort(ids.begin(), ids.end(), [&](std::size_t a, std::size_t b) { return uses[a] > uses[b]; });
  std::string text = fmt::format("{}", ids.size());
  for (std::size_t i = 0; i < std::min(shown, ids.size()); ++i)
    text += fmt::format("{}{} ({})", i == 0 ? ": " : ", ", material_name(robot, static_cast<MaterialId>(ids[i])), uses[ids[i]]);
  if (ids.size() > shown) text += fmt::format(", and {} more", ids.size() - shown);
  return text;
}

void line(const std::string& what, const std::string& text) { fmt::print("  {:<12}{}\n", what, text); }

void describe(const Robot& robot) {
  const render::Bounds box = rest_bounds(robot);
  const Eigen::Vector3f size = box.high - box.low;
  fmt::print("{}\n", robot.name);
  line("masses", fmt::to_string(robot.masses.size()));
  line("springs", fmt::format("{} ({:.1f} a mass)", robot.springs.size(),
                              2.0 * static_cast<double>(robot.springs.size()) / static_cast<double>(robot.masses.size())));
  line("faces", fmt::to_string(robot.faces.size()));
  line("materials", materials_used(robot));
  line("size", fmt::format("{:.3g} x {:.3g} x {:.3g} m", size.x(), size.y(), size.z()));
}

int tell_machine(const std::string& ffmpeg) {
  fmt::print("{}\n", program_version);
  for (const auto& [what, found, advice] : inspect_machine(ffmpeg)) {
    fmt::print("  {:<17}{}\n", what, found);
    if (!advice.empty()) fmt::print("  {:<17}-> {}\n", "", advice);
  }
  return 0;
}

// "ocean, density 1000, ..." as the options would say it.
std::string environment_text(const Configuration& configuration) {
  std::string text(name_of(configuration.environment));
  const nlohmann::ordered_json json = json_of(configuration);
  for (auto item = std::next(json.find("environment")); item != json.end(); ++item)
    text += fmt::format(", {} {}", item.key(), item.value().dump());
  return text;
}

void describe(const TrajectoryReader& trajectory) {
  constexpr std::size_t shown = 20;
  const Configuration& configuration = trajectory.configuration();
  fmt::print("{}\n", trajectory.path().string());
  line("recorded by", trajectory.program() + " on " + trajectory.device_name());
  line("frames", trajectory.frames() == 0 ? "none"
                                          : fmt::format("{}, every {} steps, {:.6g} s to {:.6g} s", trajectory.frames(),
                                                        trajectory.every(), trajectory.time(0),
                                                        trajectory.time(trajectory.frames() - 1)));
  line("solver", fmt::format("{}, dt {} s, damping {} 1/s", name_of(configuration.solver), configuration.dt, configuration.damping));
  line("environment", environment_text(configuration));
  if (trajectory.seed()) line("seed", fmt::to_string(*trajectory.seed()));
  line("robots", fmt::format("{}, {} masses", trajectory.robots().size(), trajectory.mass_count()));
  for (std::size_t i = 0; i < std::min(shown, trajectory.robots().size()); ++i) {
    const auto& [robot, group, exploded_at, bad_spring] = trajectory.robots()[i];
    std::string text = fmt::format("{} masses, {} springs, {} faces", robot.masses.size(), robot.springs.size(), robot.faces.size());
    if (exploded_at) text += fmt::format(", exploded at {:.6g} s", *exploded_at);
    if (bad_spring) text += fmt::format(", spring {}", *bad_spring);
    fmt::print("    {}: {}\n", group, text);
  }
  if (trajectory.robots().size() > shown) fmt::print("    and {} more\n", trajectory.robots().size() - shown);
}

int tell(const InfoOptions& options) {
  if (options.paths.empty()) return tell_machine(options.ffmpeg);
  for (const std::filesystem::path path : options.paths) {
    if (is_trajectory_name(path)) {
      describe(TrajectoryReader(path));
    } else {
      for (const Robot& robot : load_robots(std::span(&path, 1))) describe(robot);
    }
  }
  return 0;
}

}  // namespace

void add_info_command(CLI::App& program, const Choose& choose) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = program.add_subcommand("info", "What a robot or trajectory file holds; without one, what this machine can do");
  command->add_option("ROBOTS", options->paths, "Robot files (.json, .cbor), folders of them, trajectories (.h5)")->type_name("PATH");
  add_text(*command, "--ffmpeg", options->ffmpeg, "The encoder to look at (default: MERCURY_FFMPEG, else ffmpeg)",
           "PROGRAM");
  command->callback([options, choose] { choose([options] { return tell(*options); }); });
}

}  // namespace mercury
