// SPDX-License-Identifier: Apache-2.0
// mercury info: describes robot files, recordings and runs of evolutions, or what this machine can do.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/base/version.h"
#include "app/commands/description.h"
#include "app/commands/info_json.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/robot_inputs.h"
#include "app/recording/repro.h"
#include "app/recording/trajectory_layout.h"
#include "app/recording/trajectory_reader.h"
#include "mercury/body_properties.h"
#include "mercury/cuda_devices.h"
#include "mercury/generator.h"
#include "mercury/inspect.h"
#include "mercury/origin.h"
#include "mercury/real_body.h"
#include "mercury/run_folder.h"

namespace mercury {
namespace {

struct InfoOptions {
  RobotInputs robots;
  std::string ffmpeg;
  bool json = false;
};

// "9: muscle 3 (120), bone (14), ..., and 4 more", the most used first.
std::string materials_text(const Inspection& inspection) {
  constexpr std::size_t shown = 5;
  std::vector<MaterialUse> uses = inspection.materials;
  std::stable_sort(uses.begin(), uses.end(), [](const auto& a, const auto& b) { return a.springs > b.springs; });
  std::string text = fmt::format("{}", uses.size());
  for (std::size_t i = 0; i < std::min(shown, uses.size()); ++i)
    text += fmt::format("{}{} ({})", i == 0 ? ": " : ", ", uses[i].name, uses[i].springs);
  if (uses.size() > shown) text += fmt::format(", and {} more", uses.size() - shown);
  return text;
}

// A line for each actuator that the robot names: "left: 120 springs of material 1, 5".
void print_actuators(const Inspection& inspection) {
  constexpr std::size_t shown = 20;
  const auto& actuators = inspection.actuators;
  for (std::size_t i = 0; i < std::min(shown, actuators.size()); ++i) {
    const auto& [actuator, springs] = actuators[i];
    print_line(i == 0 ? "actuators" : "", fmt::format("{}: {} spring{} of material {}", actuator.name, springs,
                                                      springs == 1 ? "" : "s", fmt::join(actuator.materials, ", ")));
  }
  if (actuators.size() > shown) print_line("", fmt::format("and {} more", actuators.size() - shown));
}

// What the robot senses, and the brain that drives its actuators.
void print_brain(const Robot& robot) {
  std::vector<std::string_view> kinds;
  for (const Sensor& sensor : robot.sensors)
    if (const auto kind = description_of(sensor.kind).name; std::ranges::find(kinds, kind) == kinds.end())
      kinds.push_back(kind);
  if (!kinds.empty()) print_line("senses", fmt::format("{}", fmt::join(kinds, ", ")));
  if (!robot.brain) return;
  const BrainLayout layout = brain_layout(robot);
  print_line("brain", fmt::format("{} senses, {} neurons, {} weights, drives {} actuator{}, thinks every {:.3g} s",
                                  layout.senses.size(), layout.neurons.size(), layout.weights, layout.driven.size(),
                                  layout.driven.size() == 1 ? "" : "s", robot.brain->period));
  std::vector<std::string> gates;
  for (const NeuronLayer& layer : robot.brain->layers) {
    if (!layer.is_gated()) continue;
    const std::string keep =
        !layer.keep_layer.empty() ? layer.keep_layer : fmt::format("{}", fmt::join(layer.keep, " "));
    gates.push_back(layer.name + " (" + (layer.gate.empty() ? "" : "gate " + layer.gate) +
                    (layer.gate.empty() || keep.empty() ? "" : ", ") + (keep.empty() ? "" : "keep " + keep) + ")");
  }
  if (!gates.empty()) print_line("gates", fmt::format("{}", fmt::join(gates, ", ")));
}

// "1200 muscles", "1200 muscles, 300 by half waves"
std::string muscles_text(const Inspection& inspection) {
  std::size_t by_half_waves = 0;
  for (const MaterialUse& use : inspection.materials)
    if (use.material.half_wave && use.material.amplitude != 0) by_half_waves += use.springs;
  return fmt::format("{} muscles{}", inspection.muscles,
                     by_half_waves > 0 ? fmt::format(", {} by half waves", by_half_waves) : "");
}

std::string surface_text(const Inspection& inspection) {
  if (inspection.faces == 0) return "none";
  std::string text = inspection.closed ? "closed" : fmt::format("open at {} edges", inspection.open_edges);
  text += fmt::format(", Euler characteristic {}, {:.3g} m2", inspection.euler_characteristic, inspection.area);
  if (inspection.closed) text += fmt::format(", {:.3g} m3", inspection.volume);
  if (inspection.crowded_edges > 0) text += fmt::format(", {} edges of more than two faces", inspection.crowded_edges);
  return text;
}

std::string kilobytes(std::size_t bytes) { return fmt::format("{:.1f} kB", static_cast<double>(bytes) / 1024); }

// Whether a GPU can step the robot in the fast memory of a block (docs/performance.md): on any device, and on each GPU
// of this machine.
void describe_fit(const Robot& robot) {
  constexpr std::size_t smallest = 48 * 1024;  // every CUDA device has at least this per block
  const Configuration configuration{.environment = environment_made_for(robot)};
  const std::size_t bytes = chip_bytes(robot, configuration);
  print_line("on a chip", fmt::format("needs {} of a CUDA block's memory {}: {}", kilobytes(bytes),
                                      has_ground(configuration.environment) ? "on land" : "in water",
                                      bytes <= smallest ? "fits every CUDA device, which has 48 kB or more"
                                                        : "more than the 48 kB of the smallest CUDA devices"));
  for (int device = 0; device < cuda_device_count(); ++device) {
    const ChipFit fit = chip_fit(robot, configuration, device);
    const std::string where = !fit.on_chip     ? "does not fit, stepped in device memory, more slowly"
                              : fit.blocks > 1 ? fmt::format("fits in {} parts", fit.blocks)
                              : !fit.contacts_on_chip && has_contacts(configuration.environment)
                                  ? "fits but for its contacts"
                                  : "fits";
    print_line("", fmt::format("{} ({} a block): {}, {} such robots at once", cuda_device_name(device),
                               kilobytes(fit.most_bytes), where, fit.robots_at_once));
  }
  print_line("", "the CPU takes any size");
}

// "12 kPa"
std::string pascals(double value) {
  if (value >= 1e6) return fmt::format("{:.3g} MPa", value / 1e6);
  if (value >= 1e3) return fmt::format("{:.3g} kPa", value / 1e3);
  return fmt::format("{:.3g} Pa", value);
}

// What it is made of, and how fast it vibrates (docs/formats.md).
void describe_mechanics(const Robot& robot) {
  const double scale = static_cast<double>(stiffness_scale_of(environment_made_for(robot)));
  const BodyProperties body = body_properties(robot, scale);
  const std::string scaled = scale == 1 ? "" : fmt::format(", with a stiffness scale of {:.6g}", scale);
  const std::size_t fixed = robot.fixed.size();
  print_line("physics", std::string(name_of(physics_of(robot))));
  print_line("mass", fmt::format("{:.4g} kg{}", body.mass,
                                 fixed == 0 ? "" : fmt::format(", {} point{} fixed", fixed, fixed == 1 ? "" : "s")));
  print_line("density", body.density ? fmt::format("{:.4g} kg/m3", *body.density) : "-");
  print_line("modulus", body.modulus ? pascals(*body.modulus) + scaled : "-");
  print_line("vibrates",
             body.lowest_frequency ? fmt::format("from {:.3g} Hz on{}", *body.lowest_frequency, scaled) : "-");
  print_line("largest dt",
             body.largest_dt ? fmt::format("{:.3g} s with the force solver{}", *body.largest_dt, scaled) : "-");
}

void describe(const Robot& robot, const std::filesystem::path&) {
  const Inspection found = inspect(robot);
  const std::string kind = kind_of(robot), environment = environment_of(robot);
  const Generator* generator = find_generator(kind);
  print_heading(robot.name);
  if (!kind.empty() || !environment.empty())
    print_line(
        "made",
        fmt::format("{}{}{}", kind.empty() ? "" : "as " + (generator ? generator->noun : "a " + kind + " robot"),
                    kind.empty() || environment.empty() ? "" : ", ", environment.empty() ? "" : "for " + environment));
  print_line("masses",
             fmt::format("{}{}", found.masses,
                         found.loose_masses > 0 ? fmt::format(", {} without a spring", found.loose_masses) : ""));
  print_line("springs", fmt::format("{}, {:.1f} per mass, {:.3g} to {:.3g} m, {}", found.springs, found.springs_a_mass,
                                    found.shortest_spring, found.longest_spring, muscles_text(found)));
  print_line("faces", fmt::to_string(found.faces));
  print_line("surface", surface_text(found));
  print_line("materials", materials_text(found));
  if (!robot.actuators.empty()) print_actuators(found);
  print_brain(robot);
  print_line("size", fmt::format("{:.3g} x {:.3g} x {:.3g} m", found.extent.x, found.extent.y, found.extent.z));
  describe_mechanics(robot);
  describe_fit(robot);
  if (found.components > 1) print_line("parts", fmt::format("{} that no spring joins", found.components));
}

int describe_machine(const std::string& ffmpeg) {
  fmt::print("{}\n", program_version);
  for (const auto& [what, found, advice] : inspect_machine(ffmpeg)) {
    fmt::print("  {:<17}{}\n", what, found);
    if (!advice.empty()) fmt::print("  {:<17}-> {}\n", "", advice);
  }
  return 0;
}

std::string rhythm_text(const TrajectoryReader& trajectory) {
  if (trajectory.frame_rate()) return fmt::format("{:.6g} per second", *trajectory.frame_rate());
  return fmt::format("every {} steps", trajectory.every());
}

void describe(const TrajectoryReader& trajectory) {
  constexpr std::size_t shown = 20;
  const Configuration& configuration = trajectory.configuration();
  print_heading(trajectory.path().string());
  if (trajectory.unfinished()) {
    const std::filesystem::path& path = trajectory.path();
    const bool temporary = path.extension() == ".part";
    print_line("unfinished", "its program was killed, or is still recording; it holds the frames below");
    print_line("",
               fmt::format("mercury render, mercury view and Python's Recording open it as it is{}",
                           temporary ? "; to keep it, rename it to " + path.stem().stem().filename().string() : ""));
  }
  print_line("recorded by", trajectory.program() + " on " + trajectory.device_name());
  print_line("frames", trajectory.frames() == 0
                           ? "none"
                           : fmt::format("{}, {}, {:.6g} s to {:.6g} s", trajectory.frames(), rhythm_text(trajectory),
                                         trajectory.time(0), trajectory.time(trajectory.frames() - 1)));
  print_line("solver", solver_text(configuration));
  print_line("environment", environment_text(configuration));
  if (trajectory.seed()) print_line("seed", fmt::to_string(*trajectory.seed()));
  print_line("robots", fmt::format("{}, {} masses", trajectory.robots().size(), trajectory.mass_count()));
  for (std::size_t i = 0; i < std::min(shown, trajectory.robots().size()); ++i) {
    const auto& [robot, group, exploded_at, bad_spring] = trajectory.robots()[i];
    std::string text =
        fmt::format("{} masses, {} springs, {} faces", robot.masses.size(), robot.springs.size(), robot.faces.size());
    if (!robot.actuators.empty()) text += fmt::format(", {} actuators", robot.actuators.size());
    if (trajectory.has_brains(i)) {
      const BrainLayout layout = brain_layout(robot);
      text += fmt::format(", {} senses and {} neurons recorded", layout.senses.size(), layout.neurons.size());
    }
    if (exploded_at) text += fmt::format(", exploded at {:.6g} s", *exploded_at);
    if (bad_spring) text += fmt::format(", spring {}", *bad_spring);
    fmt::print("    {}: {}\n", printable(group), text);
  }
  if (trajectory.robots().size() > shown) fmt::print("    and {} more\n", trajectory.robots().size() - shown);
}

void describe(const Repro& repro, const std::filesystem::path& file) {
  print_heading(file.string());
  print_line("robot", fmt::format("{}, {} masses, {} springs, {} faces", repro.robot.name, repro.robot.masses.size(),
                                  repro.robot.springs.size(), repro.robot.faces.size()));
  print_line("exploded",
             fmt::format("at {:.6g} s{}, seen on {}", repro.exploded_at,
                         repro.culprit_spring == no_spring ? "" : fmt::format(", spring {}", repro.culprit_spring),
                         repro.device_name));
  print_line("repeats", fmt::format("steps {} to {}, with {} changes by the user on the way", repro.clock.step,
                                    repro.last_step, repro.changes.size()));
  print_line("solver", solver_text(repro.configuration));
  print_line("environment", environment_text(repro.configuration));
}

void describe(const SceneFile& scene) {
  constexpr std::size_t shown = 20;
  const Configuration configuration = configuration_of(scene);
  const ViewSettings view = scene.view();
  print_heading(scene.path().string());
  print_line("robots", fmt::format("{} file{}", scene.robots().size(), scene.robots().size() == 1 ? "" : "s"));
  for (std::size_t i = 0; i < std::min(shown, scene.robots().size()); ++i)
    fmt::print("    {}\n", printable(scene.robots()[i]));
  if (scene.robots().size() > shown) fmt::print("    and {} more\n", scene.robots().size() - shown);
  for (const RandomRobots& random : scene.random())
    print_line("random", fmt::format("{} of kind {}, seed {}, from robot {} on", random.count, random.kind, random.seed,
                                     random.first));
  print_line("solver", solver_text(configuration));
  print_line("environment", environment_text(configuration));
  print_line("camera", std::string(name_of(view.camera.mode)));
  print_line("color", std::string(view.color->key));
}

// Reads what the paths name and hands it on: take(robot, file), take(recording), take(repro, file), take(run),
// take(scene).
template <class Take>
void for_each_subject(const RobotInputs& robots, const Take& take) {
  for (const std::filesystem::path& path : robots.paths()) {
    if (is_readable_trajectory_name(path)) {
      take(TrajectoryReader(path, shown_work()));
    } else if (is_repro_name(path)) {
      take(load_repro(path), path);
    } else if (is_run_folder(path) && robots.chosen_of_runs().empty()) {
      take(RunHistory(path));
    } else if (is_scene_name(path)) {
      take(SceneFile(path));
    } else {
      for (const auto& [file, robot] : robots.load({path})) take(robot, file);
    }
  }
}

// One document, whatever the paths: a list for each kind of what they name.
class InfoDocument {
 public:
  void operator()(const Robot& robot, const std::filesystem::path& file) { add("robots", info_of(robot, file)); }
  void operator()(const TrajectoryReader& recording) { add("recordings", info_of(recording)); }
  void operator()(const Repro& repro, const std::filesystem::path& file) { add("repros", info_of(repro, file)); }
  void operator()(const RunHistory& run) { add("runs", info_of(run)); }
  void operator()(const SceneFile& scene) { add("scenes", info_of(scene)); }

  void set_machine(const std::vector<Finding>& machine) { document_["machine"] = info_of(machine); }
  void print() const {
    fmt::print("{}\n", document_.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }

 private:
  void add(const char* list, nlohmann::ordered_json entry) { document_[list].push_back(std::move(entry)); }

  nlohmann::ordered_json document_{{"program", program_version},
                                   {"machine", nullptr},
                                   {"robots", nlohmann::ordered_json::array()},
                                   {"recordings", nlohmann::ordered_json::array()},
                                   {"repros", nlohmann::ordered_json::array()},
                                   {"runs", nlohmann::ordered_json::array()},
                                   {"scenes", nlohmann::ordered_json::array()}};
};

int info(const InfoOptions& options) {
  prepare_cuda_for(0);
  if (options.json) {
    InfoDocument document;
    if (options.robots.empty()) document.set_machine(inspect_machine(options.ffmpeg));
    for_each_subject(options.robots, [&](const auto&... subject) { document(subject...); });
    document.print();
    return 0;
  }
  if (options.robots.empty()) return describe_machine(options.ffmpeg);
  for_each_subject(options.robots, [](const auto&... subject) { describe(subject...); });
  return 0;
}

}  // namespace

void add_info_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<InfoOptions>();
  const Command command =
      program.add_command("info", "Describe robot files, recordings and runs; without a file, this machine");
  options->robots.add_to(command,
                         "Robot files (.json, .cbor), folders of them, recordings (.h5), explosions (.repro), scenes "
                         "(.toml), runs of mercury evolve");
  command.add_flag("--json", options->json, "Print JSON instead of text").on_first_screen();
  add_text(command, "--ffmpeg", options->ffmpeg, "The video encoder to check (default: MERCURY_FFMPEG, else ffmpeg)",
           "PROGRAM")
      .on_first_screen();
  command.when_chosen([options, choose] { choose([options] { return options->robots.status(info(*options)); }); });
}

}  // namespace mercury
