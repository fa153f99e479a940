// SPDX-License-Identifier: Apache-2.0
// Sensors and brains in robot files: what is read, what is written, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mercury/robot_file.h"
#include "robots/carried_points.h"
#include "robots/file/document.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A chain of three springs with materials 1, 2 and 3 of the default table, and these members.
std::string chain_with(const std::string& members) {
  return R"({"format":"mercury-robot","version":1,"name":"chain","masses":[[0,0,0],[1,0,0],[2,0,0],[3,0,0]],)"
         R"("springs":[[0,1,1],[1,2,2],[2,3,3]],"faces":[],"actuators":[{"name":"a","materials":[1]},{"name":"b","materials":[2,3]}],)" +
         members + "}";
}

const std::string whole =
    R"("sensors":[{"kind":"clock","frequency":6.5,"phase":0.25},{"kind":"strain","actuator":"b","gain":2,"noise":0.1,"delay":0.04},)"
    R"({"kind":"touch","masses":[0,3]},{"kind":"strain_rate","springs":[2]},{"kind":"neuron","layer":"motor","neuron":1}],)"
    R"("brain":{"period":0.01,"seed":7,"layers":[)"
    R"({"name":"hidden","neurons":2,"activation":"sigmoid","alpha":[0.5,1],"bias":[0.1,-0.2],)"
    R"("inputs":[{"from":"senses","weights":[[1,2,3,4,5,6],[0.1,0.2,0.3,0.4,0.5,0.6]]},{"from":"hidden","edges":[[0,1,-0.7]],"rate":0.01}]},)"
    R"({"name":"motor","neurons":2,"alpha":0.3,"inputs":[{"from":"hidden","weights":[[1,0],[0,1]]}]}],)"
    R"("outputs":[{"actuator":"b","layer":"motor","neuron":0}]})";

class BrainsInFiles : public testing::TestWithParam<RobotFormat> {
 protected:
  static Robot read(const std::string& json) {
    if (GetParam() == RobotFormat::json) return parse_robot(json, GetParam());
    std::string cbor;
    CborWriter writer(cbor);
    read_json(json, writer);
    return parse_robot(cbor, GetParam());
  }
  static std::string refusal(const std::string& members) {
    return mercury::refusal([&] { read(chain_with(members)); });
  }
};
INSTANTIATE_TEST_SUITE_P(Formats, BrainsInFiles, testing::Values(RobotFormat::json, RobotFormat::cbor),
                         [](const auto& format) { return format.param == RobotFormat::json ? "json" : "cbor"; });

TEST_P(BrainsInFiles, AreRead) {
  const Robot robot = read(chain_with(whole));
  ASSERT_EQ(robot.sensors.size(), 5u);
  EXPECT_EQ(robot.sensors[0], (Sensor{.kind = SensorKind::clock, .frequency = 6.5f, .phase = 0.25f}));
  EXPECT_EQ(robot.sensors[1],
            (Sensor{.kind = SensorKind::strain, .actuator = "b", .gain = 2, .noise = 0.1f, .delay = 0.04f}));
  EXPECT_THAT(robot.sensors[2].masses, ElementsAre(0, 3));
  EXPECT_THAT(robot.sensors[3].springs, ElementsAre(2));
  EXPECT_EQ(robot.sensors[4].layer, "motor");
  const Brain& brain = *robot.brain;
  EXPECT_EQ(brain.period, 0.01f);
  EXPECT_EQ(brain.seed, 7u);
  ASSERT_EQ(brain.layers.size(), 2u);
  EXPECT_EQ(brain.layers[0].activation, Activation::sigmoid);
  EXPECT_THAT(brain.layers[0].alpha, ElementsAre(0.5f, 1.0f));
  EXPECT_THAT(brain.layers[0].bias, ElementsAre(0.1f, -0.2f));
  EXPECT_EQ(brain.layers[0].inputs[0].weights.size(), 12u);
  EXPECT_THAT(brain.layers[0].inputs[1].edges, ElementsAre(NeuronEdge{0, 1, -0.7f}));
  EXPECT_EQ(brain.layers[0].inputs[1].rate, 0.01f);
  EXPECT_EQ(brain.layers[1].activation, Activation::tanh);
  EXPECT_THAT(brain.layers[1].alpha, ElementsAre(0.3f));
  EXPECT_EQ(brain.outputs, (std::vector<NeuronOutput>{{"b", "motor", 0}}));
}

TEST_P(BrainsInFiles, ComeBackAsTheyWereWritten) {
  Robot robot = read(chain_with(whole));
  robot.brain->outputs.clear();
  robot.brain->layers[0].inputs[0].weights[3] = 7.0385307e-26f;  // whose shortest text rounds twice by way of a double
  const std::string written = serialize_robot(robot, GetParam());
  EXPECT_EQ(parse_robot(written, GetParam()), robot);
  EXPECT_EQ(serialize_robot(parse_robot(written, GetParam()), GetParam()), written);
  const std::string json = serialize_robot(robot, RobotFormat::json);
  EXPECT_THAT(json, HasSubstr(R"("requires":["brain"])"));
  Robot per_actuator = robot;
  per_actuator.brain->per_actuator = true;
  per_actuator.sensors.clear();
  per_actuator.brain->layers = {{.name = "one", .neurons = 1, .alpha = {}, .bias = {}, .inputs = {}}};
  EXPECT_EQ(parse_robot(serialize_robot(per_actuator, GetParam()), GetParam()), per_actuator);
}

// A layer is gated by one that stands before it, keeps what another says or a number, and says so in `requires`.
TEST_P(BrainsInFiles, HaveGates) {
  const Robot robot = read(
      chain_with(R"("brain":{"layers":[{"name":"in","neurons":2,"activation":"sigmoid"},)"
                 R"({"name":"cell","neurons":2,"gate":"in","keep":"out"},)"
                 R"({"name":"out","neurons":2,"alpha":0.5,"keep":[0,1]},{"name":"motor","neurons":2,"keep":0}]})"));
  const std::vector<NeuronLayer>& layers = robot.brain->layers;
  EXPECT_FALSE(layers[0].is_gated());
  EXPECT_EQ(layers[1].gate, "in");
  EXPECT_EQ(layers[1].keep_layer, "out");
  EXPECT_THAT(layers[2].keep, ElementsAre(0, 1));
  EXPECT_EQ(layers[2].gate, "");
  EXPECT_THAT(layers[3].keep, ElementsAre(0));
  const std::string written = serialize_robot(robot, GetParam());
  EXPECT_EQ(parse_robot(written, GetParam()), robot);
  EXPECT_EQ(serialize_robot(parse_robot(written, GetParam()), GetParam()), written);
  EXPECT_THAT(serialize_robot(robot, RobotFormat::json), HasSubstr(R"("requires":["brain","gates"])"));
}

TEST_P(BrainsInFiles, SensorsNeedNoBrain) {
  const Robot robot = read(chain_with(R"("sensors":[{"kind":"up"}])"));
  EXPECT_EQ(robot.sensors.size(), 1u);
  EXPECT_FALSE(robot.brain);
}

TEST_P(BrainsInFiles, ErrorsSayWhere) {
  const auto sensor = [](const std::string& text) { return refusal("\"sensors\":[" + text + "]"); };
  EXPECT_THAT(sensor(R"({"kind":"smell"})"),
              HasSubstr("/sensors/0/kind: \"smell\" is no kind of sensor; there are strain,"));
  EXPECT_EQ(sensor("{}"), "/sensors/0: kind is missing");
  EXPECT_EQ(sensor("7"), "/sensors/0: must be an object, not a number");
  EXPECT_EQ(sensor(R"({"kind":"up"},{"kind":"strain","gain":"high"})"),
            "/sensors/1/gain: must be a number, not a text");
  EXPECT_EQ(sensor(R"({"kind":"touch","masses":[0,-1]})"), "/sensors/0/masses/1: must be a whole number, not a number");
  EXPECT_EQ(sensor(R"({"kind":"strain","actuator":"tail"})"),
            "/sensors/0/actuator: no actuator is named \"tail\"; the robot has a, b");
  EXPECT_EQ(refusal(R"("sensors":{})"), "/sensors: must be an array, not an object");

  const auto brain = [](const std::string& text) { return refusal("\"brain\":" + text); };
  const auto layer = [&](const std::string& text) { return brain(R"({"layers":[{"name":"motor",)" + text + "}]}"); };
  EXPECT_EQ(brain("[]"), "/brain: must be an object, not an array");
  EXPECT_EQ(brain("{}"), "/brain: layers is missing");
  EXPECT_EQ(brain(R"({"layers":[]})"), "/brain/layers: a brain needs at least one layer");
  EXPECT_EQ(brain(R"({"layers":[],"per":"robots"})"),
            "/brain/per: \"robots\" is no copy of a brain; there are robot, actuator");
  EXPECT_EQ(layer(R"("activation":"tanh")"), "/brain/layers/0: neurons is missing");
  EXPECT_EQ(layer(R"("neurons":1e9)"), "/brain/layers/0/neurons: must be a whole number, not a number");
  EXPECT_EQ(layer(R"("neurons":5000)"), "/brain/layers/0/neurons: 5000 is out of range, at most 4096");
  EXPECT_EQ(layer(R"("neurons":2,"inputs":[{"from":"motor"}])"),
            "/brain/layers/0/inputs/0: weights or edges are missing");
  EXPECT_EQ(layer(R"("neurons":2,"inputs":[{"from":"motor","weights":[[1,2]]}])"),
            "/brain/layers/0/inputs/0/weights: 1 rows, the layer has 2 neurons");
  EXPECT_EQ(layer(R"("neurons":2,"inputs":[{"from":"motor","weights":[[1,2],[1]]}])"),
            "/brain/layers/0/inputs/0/weights/1: 1 numbers, the rows before it have 2");
  EXPECT_EQ(layer(R"("neurons":2,"inputs":[{"from":"senses","weights":[[1],[1]]}])"),
            "/brain/layers/0/inputs/0/from: the robot has no sensors");
  EXPECT_EQ(layer(R"("neurons":2,"inputs":[{"from":"motor","edges":[[0,1]]}])"),
            "/brain/layers/0/inputs/0/edges/0: an edge is [to, from, weight]");
  EXPECT_EQ(
      layer(R"("neurons":3)"),
      "/brain/layers/0: the last layer has 3 neurons, the robot has 2 actuators; name outputs, or make them equal");
  EXPECT_EQ(layer(R"("neurons":2,"bias":[1,"x"])"), "/brain/layers/0/bias/1: must be a number, not a text");
  EXPECT_THAT(layer(R"("neurons":2,"bias":[1,1e39])"), HasSubstr("/brain/layers/0/bias/1: "));
  EXPECT_EQ(layer(R"("neurons":2,"gate":1)"), "/brain/layers/0/gate: must be a text, not a number");
  EXPECT_EQ(layer(R"("neurons":2,"gate":"")"), "/brain/layers/0/gate: must name a layer");
  EXPECT_EQ(layer(R"("neurons":2,"gate":"input")"),
            "/brain/layers/0/gate: no layer is named \"input\"; the brain has motor");
  EXPECT_EQ(layer(R"("neurons":2,"keep":{})"), "/brain/layers/0/keep: must be a number, not an object");
  EXPECT_EQ(layer(R"("neurons":2,"keep":[])"), "/brain/layers/0/keep: an empty list; leave it out for 1 - gate");
  EXPECT_EQ(layer(R"("neurons":2,"keep":[1])"), "");
  EXPECT_EQ(layer(R"("neurons":2,"keep":[1,"x"])"), "/brain/layers/0/keep/1: must be a number, not a text");
  EXPECT_EQ(layer(R"("neurons":2,"keep":-1)"), "/brain/layers/0/keep: a keep is 0 to 1, or the name of a layer");
}

TEST(BrainOfAChangedBody, StaysIfItFits) {
  const Robot robot = parse_robot(chain_with(whole), RobotFormat::json);
  Robot longer = robot;
  longer.sensors.clear();
  longer.brain.reset();
  longer.masses.push_back({4, 0, 0});
  longer.springs.push_back({3, 4, 1, 1});
  carry_brain(robot, longer);
  EXPECT_FALSE(longer.brain) << "its sensors name masses of another body";

  Robot by_name = robot;
  by_name.sensors[2] = {.kind = SensorKind::touch};
  by_name.sensors[3] = {.kind = SensorKind::strain_rate, .actuator = "a"};
  carry_brain(by_name, longer);
  EXPECT_EQ(longer.brain, robot.brain);
  longer.brain.reset();
  longer.actuators[0].name = "c";
  carry_brain(by_name, longer);
  EXPECT_FALSE(longer.brain) << "no actuator is named a";
  EXPECT_TRUE(longer.sensors.empty());
}

}  // namespace
}  // namespace mercury
