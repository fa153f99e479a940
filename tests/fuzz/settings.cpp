// SPDX-License-Identifier: Apache-2.0
// Configuration files, camera files, scenes, results, keys, and what the window remembers.
#include <nlohmann/json.hpp>

#include "app/live/scene_text.h"
#include "app/live/session_settings.h"
#include "app/options/config_file.h"
#include "app/options/option_values.h"
#include "app/options/result_file.h"
#include "app/options/scene_file.h"
#include "app/options/simulation_options.h"
#include "app/recording/configuration_json.h"
#include "app/scene/camera_plan.h"
#include "app/window/toolkit/key_map.h"
#include "mercury/error.h"
#include "tests/fuzz/target.h"

namespace mercury::fuzz {

// A program with two commands, one of them with a command of its own.
void check_configuration_file(std::string_view input) {
  const CommandTree tree;
  const Command program = tree.root();
  SimulationOptions simulation;
  std::string text;
  bool flag = false;
  std::vector<std::string> several;
  const Command run = program.add_command("run", "");
  simulation.add_to(run);
  add_text(run, "--text", text, "", "TEXT");
  run.add_flag("--flag", flag, "");
  run.add_list("--several", several, "");
  const Command made = program.add_command("new", "").add_command("voxel", "");
  add_text(made, "--text", text, "", "TEXT");
  const std::string path = scratch_file(input, "input.toml");
  for (const Command& command : {run, made}) {
    const ConfigFile file(path, program, command, {"--dt=1"});
    for (const std::string& argument : file.arguments())
      require(argument.starts_with("--"), "an argument that is not an option: " + argument);
    if (!command.is_within(run)) continue;
    try {
      std::vector<std::string> arguments{"run"};
      arguments.insert(arguments.end(), file.arguments().begin(), file.arguments().end());
      tree.parse(arguments);
      simulation.configuration();
    } catch (const UnknownArgument&) {
    } catch (const MissingValue&) {
    } catch (const ParseFailure&) {
    } catch (const InputError& error) {
      throw InputError(file.located(error.what()));
    }
  }
}

std::vector<std::string> configuration_file_seeds() {
  return {"dt = 0.001\n[run]\ntext = \"a\"\nflag = true\nseveral = [\"a\", \"b\"]\nflow = [1, 0.5, -2]\n",
          "# all\nenvironment = \"land\"\nfriction = 0.5\nno-self-collision = true\n[new.voxel]\ntext = 'b'\n",
          "[run]\nsolver = \"xpbd\"\ndevice = \"\"\"cpu\"\"\"\nthreads = 2\ndamping = 1e-3\ndensity = 1_000.5\ngravity "
          "= 0x10\n"};
}

void check_camera(std::string_view input) {
  const CameraPlan plan = load_camera(scratch_file(input, "input.json"));
  const std::string first = scratch_folder() + "/first.json", second = scratch_folder() + "/second.json";
  try {
    save_camera(first, plan);
  } catch (const InputError&) {
    return;
  }
  save_camera(second, load_camera(first));
  require(content_of(first) == content_of(second), "the camera does not read back as it was written");
}

std::vector<std::string> camera_seeds() {
  return {R"({"format":"mercury-camera","version":1,"mode":"still","azimuth":-1.3,"elevation":0.2,"target":[0,0,1],)"
          R"("distance":2,"zoom":1.5,"field_of_view":0.6})",
          R"({"format":"mercury-camera","version":1,"mode":"follow","robot":"eel"})",
          R"({"format":"mercury-camera","version":1,"mode":"turntable","period":12})"};
}

void check_session(std::string_view input) {
  Messages messages;
  const std::string path = scratch_file(input, "input.toml");
  const SessionSettings settings = load_session_settings(path, messages);
  const std::string first = scratch_folder() + "/first.toml", second = scratch_folder() + "/second.toml";
  save_session_settings(first, settings, messages);
  messages.take();
  save_session_settings(second, load_session_settings(first, messages), messages);
  for (const Message& message : messages.take()) fail("what was written is not read: " + message.text);
  require(content_of(first) == content_of(second), "the settings do not read back as they were written");
}

namespace {

// What a scene says, as the window writes it for this one robot.
std::string written_scene(const std::string& path, const SceneFile& scene) {
  Robot robot;
  robot.name = "point";
  robot.masses = {{0, 0, 0}};
  DocumentRobot document{.body = {.id = 1, .name = "point"}, .source = {.file = "point.json"}};
  document.body.robot = std::make_shared<const Robot>(robot);
  std::vector<std::string> notes;
  const std::vector<SceneRobot> robots{{&document, "point.json"}};
  return scene_files(path, robots, scene.configuration({}, notes), scene.view(), scene.held(), scene.start())
      .files.back()
      .content;
}

}  // namespace

void check_scene(std::string_view input) {
  const std::string path = scratch_file(input, "input.toml"), first = scratch_folder() + "/first.toml";
  const SceneFile scene(path);
  std::string written;
  try {
    written = written_scene(first, scene);
  } catch (const InputError&) {
    return;  // a text that is no UTF-8
  }
  scratch_file(written, "first.toml");
  require(written_scene(first, SceneFile(scratch_folder() + "/first.toml")) == written,
          "the scene does not read back as it was written");
}

void check_result(std::string_view input) {
  const RunResult result = read_result(scratch_file(input, "result.json"));
  validate(result.configuration);
  require(result.steps >= 0 && result.seconds >= 0 && result.trials >= 0, "a result of less than no time");
  require(!result.robots.empty(), "a result without robots");
  for (const RobotOfResult& robot : result.robots)
    require(robot.file.empty() != robot.random.empty(), "a robot from nowhere, or from two places");
}

std::vector<std::string> result_seeds() {
  const std::string of_all = R"({"program": "mercury 0.2.0", "device": "CPU, 1 thread", "steps": 200, "seconds": 0.2,)";
  Configuration configuration;
  configuration.environment = Land{};
  const std::string settings = R"( "configuration": )" + json_of(configuration).dump() + R"(, "robots": [)";
  const std::string hash = R"("masses": 12, "springs": 40, "physics": "paper", "hash": "0123456789abcdef"})";
  return {of_all + settings + R"({"name": "a", "random": "voxel:1:7", )" + hash + "]}",
          of_all + R"( "trials": 3, "jitter": 0.001,)" + settings + R"({"name": "b", "file": "b.json", )" + hash +
              R"(, {"name": "c", "failure": "no masses"}]})"};
}

std::vector<std::string> scene_seeds() {
  return {
      "format = \"mercury-scene\"\nversion = 1\nrobots = [\"eel.json\", \"a/b.cbor\"]\n"
      "random = [\"voxel:12:7\", \"shell:2\"]\nenvironment = \"land\"\nfriction = 0.5\nsolver = \"xpbd\"\n"
      "dt = 0.002\ncolor = \"strain\"\nshow = \"skin,labels\"\nlayout = \"race\"\n",
      "format = \"mercury-scene\"\nversion = 1\nrobots = []\ncut = \"y:0.2\"\nscale = \"-1,1\"\nplain = true\n\n"
      "[camera]\nmode = \"still\"\nazimuth = -1.3\nelevation = 0.2\ntarget = [0, 0.5, 1.0]\ndistance = 3\n",
      "format = \"mercury-scene\"\nversion = 1\nrobots = [\"x.json\"]\nattach = [\"0:12\", "
      "\"3:4:0.5,-1e-3,2:40\"]\ndrive = [\"0:left: fin:-0.5\"]\nneuron = [\"0:hidden 3:0\", \"1:motor 0 of "
      "tail:1e-3\"]\n",
      "format = \"mercury-scene\"\nversion = 1\nrobots = [\"x.json\"]\ntarget-radius = 2.5\ntarget-spread = 0.5\n"
      "target-sphere = true\nturned = true\nseed = 7\n",
      "format = \"mercury-scene\"\nversion = 1\nrobots = [\"x.json\"]\ncamera = \"follow:eel\"\n"};
}

// Lines that cannot be used are left out, so the whole is refused only to say that there are any.
void check_keys(std::string_view input) {
  window::KeyMap keys, again;
  const std::string problem = window::load_keys(keys, scratch_file(input, "keys.txt"));
  const std::string wrong = again.read(keys.text());
  require(wrong.empty(), "the keys do not read back: " + wrong);
  require(again.text() == keys.text(), "the keys do not read back as they were written");
  if (!problem.empty()) throw InputError(problem);
}

std::vector<std::string> keys_seeds() {
  return {window::KeyMap().text(), "# mine\nreset = M\nstep = Ctrl Right, Comma\nfull_screen =\nfaster = =\n",
          "undo = Ctrl Shift \xc3\xa9\r\ntheme = F5,Shift F5\n"};
}

std::vector<std::string> session_seeds() {
  Messages messages;
  const std::string path = scratch_folder() + "/seed.toml";
  SessionSettings settings;
  settings.folder = "robots";
  save_session_settings(path, settings, messages);
  return {content_of(path)};
}

}  // namespace mercury::fuzz
