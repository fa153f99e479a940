// SPDX-License-Identifier: Apache-2.0
// Robot files, JSON and CBOR, and repro files.
#include "app/recording/repro.h"
#include "mercury/error.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "mercury/voxel.h"
#include "robots/file/document.h"
#include "tests/fuzz/target.h"

namespace mercury::fuzz {
namespace {

void check_robot(std::string_view input, RobotFormat format) {
  const Robot robot = parse_robot(input, format);
  validate(robot);
  std::string written;
  try {
    written = serialize_robot(robot, format);
  } catch (const InputError&) {
    return;  // a text of a CBOR document may be no UTF-8
  }
  require(parse_robot(written, format) == robot, "the robot does not read back as it was written");
  require(serialize_robot(parse_robot(written, format), format) == written, "the same robot is written in two ways");
  voxel_grid_of(robot);
}

Robot small_robot() {
  Robot robot = random_voxel_robot({.smallest = {1, 1, 1}, .largest = {1, 1, 1}, .air = 0}, 1);
  const auto defaults = default_materials();
  robot.materials.assign(defaults.begin(), defaults.begin() + 3);
  robot.materials[2].half_wave = true;
  robot.materials[1].relaxation_time = 0.02f;
  robot.mass.assign(robot.masses.size(), 0.5f);
  robot.velocity.assign(robot.masses.size(), {0, 0, 0.25f});
  robot.fixed = {1, 0};
  robot.material_names = {"air", "a", "b"};
  for (Spring& spring : robot.springs) spring.material = 1;
  return robot;
}

Robot pair() {
  Robot robot;
  robot.name = "pair";
  robot.masses = {{0, 0, 0}, {0.1f, 0, 0}};
  robot.springs = {{0, 1, 1, 0.1f}};
  return robot;
}

// With an actuator of each kind: Mercury itself writes only actuators of materials.
std::string with_actuators(const Robot& robot) {
  std::string json = serialize_robot(robot, RobotFormat::json);
  json.insert(json.find('{') + 1, R"("actuators":[{"name":"left","materials":[2]},{"name":"tail","springs":[0]}],)");
  return json;
}

// With sensors and a brain, dense and sparse.
std::string with_brain() {
  std::string json = with_actuators(pair());
  json.insert(
      json.find('{') + 1,
      R"("sensors":[{"kind":"clock","frequency":2},{"kind":"strain","actuator":"tail","noise":0.1,"delay":0.1},)"
      R"({"kind":"touch","masses":[1]},{"kind":"neuron","layer":"h","neuron":1}],)"
      R"("brain":{"period":0.01,"layers":[{"name":"h","neurons":2,"alpha":0.5,"bias":[0,1],"inputs":[)"
      R"({"from":"senses","weights":[[1,2,3,4,5],[6,7,8,9,10]]},{"from":"h","edges":[[0,1,2]],"rate":0.1}]},)"
      R"({"name":"c","neurons":2,"gate":"h","keep":"d"},{"name":"d","neurons":2,"alpha":0.5,"keep":[0,0.5]}],)"
      R"("outputs":[{"actuator":"tail","layer":"h","neuron":0}]},)");
  return json;
}

// With an LSTM per actuator: three layers are gates of the other two.
std::string with_lstm() {
  std::string json = with_actuators(pair());
  json.insert(
      json.find('{') + 1,
      R"("sensors":[{"kind":"clock","frequency":2},{"kind":"strain","actuator":"self"}],"brain":{"per":"actuator",)"
      R"("layers":[{"name":"i","neurons":1,"activation":"sigmoid","inputs":[{"from":"senses","weights":[[1,2,3]]}]},)"
      R"({"name":"f","neurons":1,"activation":"sigmoid","bias":[1],"inputs":[{"from":"h","weights":[[0.5]]}]},)"
      R"({"name":"o","neurons":1,"activation":"sigmoid"},)"
      R"({"name":"c","neurons":1,"gate":"i","keep":"f","inputs":[{"from":"senses","edges":[[0,2,-1]]}]},)"
      R"({"name":"h","neurons":1,"gate":"o","keep":0,"inputs":[{"from":"c","edges":[[0,0,1]]}]}]},)");
  return json;
}

std::string as_cbor(const std::string& json) {
  std::string cbor;
  CborWriter writer(cbor);
  read_json(json, writer);
  return cbor;
}

}  // namespace

void check_robot_json(std::string_view input) { check_robot(input, RobotFormat::json); }
void check_robot_cbor(std::string_view input) { check_robot(input, RobotFormat::cbor); }

std::vector<std::string> robot_json_seeds() {
  return {serialize_robot(pair(), RobotFormat::json),
          serialize_robot(small_robot(), RobotFormat::json),
          with_actuators(pair()),
          with_actuators(small_robot()),
          with_brain(),
          with_lstm()};
}

std::vector<std::string> robot_cbor_seeds() {
  return {serialize_robot(pair(), RobotFormat::cbor),
          serialize_robot(small_robot(), RobotFormat::cbor),
          as_cbor(with_actuators(pair())),
          as_cbor(with_actuators(small_robot())),
          as_cbor(with_brain()),
          as_cbor(with_lstm())};
}

void check_repro(std::string_view input) {
  const Repro repro = parse_repro(input);
  validate(repro.robot);
  validate(repro.configuration);
  const std::string written = serialize_repro(repro);
  require(serialize_repro(parse_repro(written)) == written, "the repro does not read back as it was written");
}

std::vector<std::string> repro_seeds() {
  std::vector<std::string> seeds;
  for (const Environment& environment :
       {Environment(Ocean{}), Environment(OceanSimple{}), Environment(Land{}), Environment(Water{})}) {
    Repro repro{.robot = pair()};
    const auto table = materials_of(repro.robot);
    repro.robot.materials.assign(table.begin(), table.begin() + 3);
    repro.configuration.device.kind = DeviceKind::cpu;
    repro.configuration.environment = environment;
    repro.state = {.positions = repro.robot.masses, .velocities = {{0, 0, 1}, {0, 0, 0}}};
    repro.perturbations = {{.mass = 1, .target = {1, 2, 3}, .stiffness = 40}};
    ReproChange change{.step = 3, .configuration = repro.configuration};
    change.materials = repro.robot.materials;
    change.materials->back().half_wave = true;
    if (has_contacts(environment)) change.materials->back().relaxation_time = 0.02f;
    change.perturbations = repro.perturbations;
    repro.changes = {change, {.step = 4}};
    repro.exploded_at = 0.01;
    repro.last_step = 10;
    repro.device_name = "CPU";
    seeds.push_back(serialize_repro(repro));
  }
  return seeds;
}

}  // namespace mercury::fuzz
