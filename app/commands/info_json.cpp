// SPDX-License-Identifier: Apache-2.0
#include "app/commands/info_json.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/options/generator_options.h"
#include "app/recording/configuration_json.h"
#include "mercury/body_properties.h"
#include "mercury/cuda_devices.h"
#include "mercury/generator.h"
#include "mercury/import.h"
#include "mercury/inspect.h"
#include "mercury/number_text.h"
#include "mercury/origin.h"
#include "mercury/quantity.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

using Json = nlohmann::ordered_json;

Json spring_or_null(std::uint32_t spring) { return spring == no_spring ? Json() : Json(spring); }

template <class Value>
Json value_or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

Json json_of(const MaterialUse& use) {
  return {{"id", use.id},
          {"name", use.name},
          {"stiffness", shortest(use.material.stiffness)},
          {"amplitude", shortest(use.material.amplitude)},
          {"frequency", shortest(use.material.frequency)},
          {"phase", shortest(use.material.phase)},
          {"half_wave", use.material.half_wave},
          {"relaxation_time", shortest(use.material.relaxation_time)},
          {"springs", use.springs}};
}

// Whether GPUs can step it in the fast memory of a block, see docs/performance.md.
Json chip_of(const Robot& robot) {
  const Configuration configuration{.environment = environment_made_for(robot)};
  Json devices = Json::array();
  for (int device = 0; device < cuda_device_count(); ++device) {
    const ChipFit fit = chip_fit(robot, configuration, device);
    devices.push_back({{"name", cuda_device_name(device)},
                       {"block_bytes", fit.most_bytes},
                       {"on_chip", fit.on_chip},
                       {"blocks", fit.blocks},
                       {"contacts_on_chip", fit.contacts_on_chip},
                       {"robots_at_once", fit.robots_at_once}});
  }
  return {{"environment", name_of(configuration.environment)},
          {"bytes", chip_bytes(robot, configuration)},
          {"devices", devices}};
}

// A member for each parameter of a struct.
template <class Struct>
Json parameters_of(const Struct& values) {
  Json json = Json::object();
  for_each_parameter(values,
                     [&](const auto& parameter, const auto& value) { json[std::string(parameter.name)] = value; });
  return json;
}

Json json_of(const EvolutionSettings& settings) {
  const AlgorithmSettings& algorithm = settings.algorithm;
  Json axes = Json::array();
  for (const MapAxis& axis : algorithm.axes)
    axes.push_back(
        {{"quantity", axis.quantity}, {"lowest", axis.lowest}, {"highest", axis.highest}, {"cells", axis.cells}});
  Json json{{"name", algorithm.name}};
  json.update(parameters_of(algorithm));
  json.update(parameters_of(settings));
  json.erase("generations");  // planned, among the results
  json["children"] = settings.children > 0 ? settings.children : algorithm.population;
  json["axes"] = axes;
  return json;
}

Json json_of(const GenomeSpaceRequest& space) {
  Json options = Json::object();
  if (const Generator* generator = find_generator(space.kind); generator && space.founders.empty())
    for (const auto& [option, value] : options_of(*generator, space.values)) options[option.substr(2)] = value;
  return {{"kind", space.founders.empty() ? Json(space.kind) : Json()},
          {"options", options},
          {"founders", space.founders.size()},
          {"genes", name_of(space.genes)},
          {"muscles", parameters_of(space.muscles)}};
}

Json quantities_of(const Assessment& assessment) {
  Json json = Json::object();
  for (std::size_t q = 0; q < std::min(assessment.values.size(), quantities().size()); ++q)
    json[std::string(quantities()[q].name)] =
        counts(quantities()[q], assessment.fate) ? Json(assessment.values[q]) : Json();
  return json;
}

Json json_of(const RunHistory& run, const Individual& individual) {
  const Assessment& assessment = individual.assessment;
  return {
      {"id", individual.id},         {"generation", individual.generation},     {"fate", name_of(assessment.fate)},
      {"scores", assessment.scores}, {"quantities", quantities_of(assessment)}, {"line", run.line_of(individual.id)}};
}

Json files_in(const std::filesystem::path& folder) {
  std::map<std::string, Json> found;  // by name
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error))
    if (entry.is_regular_file(error)) found[entry.path().lexically_relative(folder).string()] = entry.file_size(error);
  Json files = Json::object();
  for (auto& [name, bytes] : found) files[name] = std::move(bytes);
  return files;
}

}  // namespace

Environment environment_made_for(const Robot& robot) {
  const std::string name = environment_of(robot);
  return default_configuration(physics_of(robot), is_environment(name) ? name : "").environment;
}

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json info_of(const Robot& robot, const std::filesystem::path& file) {
  const Inspection found = inspect(robot);
  const float stiffness_scale = stiffness_scale_of(environment_made_for(robot));
  const BodyProperties body = body_properties(robot, static_cast<double>(stiffness_scale));
  Json materials = Json::array(), actuators = Json::array();
  for (const MaterialUse& use : found.materials) materials.push_back(json_of(use));
  if (!robot.actuators.empty())
    for (const auto& [actuator, springs] : found.actuators)
      actuators.push_back({{"name", actuator.name}, {"materials", actuator.materials}, {"springs", springs}});
  const BrainLayout layout = brain_layout(robot);
  Json gates = Json::array();
  if (robot.brain)
    for (const NeuronLayer& layer : robot.brain->layers) {
      if (!layer.is_gated()) continue;
      Json numbers;
      for (const float keep : layer.keep) numbers.push_back(shortest(keep));
      if (layer.keep.size() == 1) numbers = shortest(layer.keep[0]);
      gates.push_back({{"layer", layer.name},
                       {"gate", text_or_null(layer.gate)},
                       {"keep", layer.keep_layer.empty() ? numbers : Json(layer.keep_layer)}});
    }
  const Json brain = robot.brain ? Json{{"senses", layout.senses},
                                        {"neurons", layout.neurons},
                                        {"weights", layout.weights},
                                        {"gates", gates},
                                        {"period", shortest(robot.brain->period)}}
                                 : Json();
  return {{"file", file.string()},
          {"name", robot.name},
          {"kind", text_or_null(kind_of(robot))},
          {"environment", text_or_null(environment_of(robot))},
          {"masses", found.masses},
          {"springs", found.springs},
          {"faces", found.faces},
          {"muscles", found.muscles},
          {"materials", materials},
          {"actuators", actuators},
          {"brain", brain},
          {"lowest", json_of(found.lowest)},
          {"highest", json_of(found.highest)},
          {"extent", json_of(found.extent)},
          {"length", shortest(found.length)},
          {"shortest_spring", shortest(found.shortest_spring)},
          {"longest_spring", shortest(found.longest_spring)},
          {"springs_per_mass", found.springs_a_mass},
          {"components", found.components},
          {"loose_masses", found.loose_masses},
          {"closed", found.closed},
          {"open_edges", found.open_edges},
          {"crowded_edges", found.crowded_edges},
          {"euler_characteristic", found.euler_characteristic},
          {"area", found.area},
          {"volume", found.volume},
          {"physics", name_of(physics_of(robot))},
          {"mass", body.mass},
          {"density", value_or_null(body.density)},
          {"stiffness_scale", shortest(stiffness_scale)},
          {"modulus", value_or_null(body.modulus)},
          {"lowest_frequency", value_or_null(body.lowest_frequency)},
          {"largest_dt", value_or_null(body.largest_dt)},
          {"chip", chip_of(robot)}};
}

Json info_of(const TrajectoryReader& recording) {
  Json robots = Json::array();
  for (std::size_t i = 0; i < recording.robots().size(); ++i) {
    const auto& [robot, group, exploded_at, culprit_spring] = recording.robots()[i];
    const BrainLayout layout = recording.has_brains(i) ? brain_layout(robot) : BrainLayout{};
    robots.push_back({{"name", robot.name},
                      {"group", group},
                      {"physics", name_of(physics_of(robot))},
                      {"masses", robot.masses.size()},
                      {"springs", robot.springs.size()},
                      {"faces", robot.faces.size()},
                      {"actuators", robot.actuators.size()},
                      {"senses", layout.senses},
                      {"neurons", layout.neurons},
                      {"exploded_at", value_or_null(exploded_at)},
                      {"first_bad_spring", value_or_null(culprit_spring)}});
  }
  const std::size_t frames = recording.frames();
  return {{"file", recording.path().string()},
          {"program", recording.program()},
          {"device", recording.device_name()},
          {"unfinished", recording.unfinished()},
          {"frames", frames},
          {"every", recording.every()},
          {"frame_rate", value_or_null(recording.frame_rate())},
          {"first_time", frames > 0 ? Json(recording.time(0)) : Json()},
          {"last_time", frames > 0 ? Json(recording.time(frames - 1)) : Json()},
          {"seed", value_or_null(recording.seed())},
          {"masses", recording.mass_count()},
          {"configuration", mercury::json_of(recording.configuration())},
          {"robots", robots}};
}

Json info_of(const Repro& repro, const std::filesystem::path& file) {
  return {{"file", file.string()},
          {"name", repro.robot.name},
          {"masses", repro.robot.masses.size()},
          {"springs", repro.robot.springs.size()},
          {"faces", repro.robot.faces.size()},
          {"exploded_at", repro.exploded_at},
          {"first_bad_spring", spring_or_null(repro.culprit_spring)},
          {"device", repro.device_name},
          {"first_step", repro.clock.step},
          {"last_step", repro.last_step},
          {"changes", repro.changes.size()},
          {"configuration", mercury::json_of(repro.configuration)}};
}

Json info_of(const RunHistory& run) {
  const RunSettings& settings = run.settings();
  Json fates = Json::object(), devices = Json::array();
  for (const Fate fate : {Fate::sound, Fate::stopped, Fate::exploded, Fate::overstretched, Fate::too_small,
                          Fate::undefined, Fate::failed})
    fates[std::string(name_of(fate))] =
        std::ranges::count(run.individuals(), fate, [](const Individual& one) { return one.assessment.fate; });
  double seconds = 0;
  for (const GenerationSummary& generation : run.generations()) {
    seconds += generation.times.seconds;
    const Json device = text_or_null(generation.times.device);
    if (!device.is_null() && std::ranges::find(devices, device) == devices.end()) devices.push_back(device);
  }
  return {{"folder", run.folder().string()},
          {"program", settings.program},
          {"physics", name_of(physics_of(settings.space))},
          {"genomes", json_of(settings.space)},
          {"objectives", settings.evolution.objectives},
          {"algorithm", json_of(settings.evolution)},
          {"trials", parameters_of(settings.evolution.trials)},
          {"configuration", mercury::json_of(settings.evolution.configuration)},
          {"generations", settings.evolution.generations},
          {"last_generation", run.generations().empty() ? Json() : Json(run.generations().back().number)},
          {"born", run.individuals().size()},
          {"living", run.living().size()},
          {"fates", fates},
          {"seconds", seconds},
          {"devices", devices},
          {"best", run.living().empty() ? Json() : json_of(run, run.individuals()[run.living().front()])},
          {"files", files_in(run.folder())}};
}

Configuration configuration_of(const SceneFile& scene) {
  std::vector<Robot> robots;
  for (const std::string& file : scene.robots()) {
    if (const ImportFormat* format = import_format_of(file))
      std::ranges::move(import_file(file, *format).robots, std::back_inserter(robots));
    else
      robots.push_back(load_robot(file));
  }
  std::vector<const Robot*> pointers;
  for (Robot& robot : robots) {
    scene.give_body(robot, robot.name);
    pointers.push_back(&robot);
  }
  std::vector<std::string> notes;
  return scene.configuration(pointers, notes);
}

Json info_of(const SceneFile& scene) {
  Json random = Json::array();
  for (const RandomRobots& robots : scene.random())
    random.push_back({{"kind", robots.kind}, {"count", robots.count}, {"seed", robots.seed}, {"first", robots.first}});
  const ViewSettings view = scene.view();
  return {{"file", scene.path().string()},
          {"robots", scene.robots()},
          {"random", random},
          {"configuration", mercury::json_of(configuration_of(scene))},
          {"color", view.color->key},
          {"camera", name_of(view.camera.mode)}};
}

Json info_of(std::span<const Finding> machine) {
  Json json = Json::array();
  for (const auto& [what, found, advice] : machine)
    json.push_back({{"what", what}, {"found", found}, {"advice", text_or_null(advice)}});
  return json;
}

}  // namespace mercury
