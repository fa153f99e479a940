// SPDX-License-Identifier: Apache-2.0
// Recordings.
#include <algorithm>

#include "app/recording/trajectory_reader.h"
#include "app/recording/trajectory_writer.h"
#include "tests/fuzz/target.h"
#include "tests/same_bits.h"

namespace mercury::fuzz {
namespace {

constexpr std::size_t most_frames = 16;  // that are compared

std::vector<Vec3> copy(std::span<const Vec3> values) { return {values.begin(), values.end()}; }
std::vector<float> copy(std::span<const float> values) { return {values.begin(), values.end()}; }

// Writes what was read to another file.
std::string written_again(TrajectoryReader& reader, std::size_t frames) {
  std::vector<const Robot*> robots;
  std::vector<Material> materials;
  for (const RecordedRobot& recorded : reader.robots()) {
    robots.push_back(&recorded.robot);
    const auto table = materials_of(recorded.robot);
    materials.insert(materials.end(), table.begin(), table.end());
    materials.resize(robots.size() * max_materials);
  }
  const std::string path = scratch_folder() + "/again.h5";
  TrajectoryWriter writer(path,
                          {.configuration = reader.configuration(),
                           .device_name = reader.device_name(),
                           .seed = reader.seed(),
                           .every = reader.every(),
                           .brains = reader.has_brains()},
                          robots, materials, "again");
  for (std::size_t i = 0; i < frames; ++i) {
    const TrajectoryWriter::Frame frame = writer.add(reader.step(i), reader.time(i));
    std::ranges::copy(copy(reader.positions(i)), frame.positions.begin());
    std::ranges::copy(copy(reader.velocities(i)), frame.velocities.begin());
    std::ranges::copy(reader.senses(i), frame.senses.begin());
    std::ranges::copy(reader.neurons(i), frame.neurons.begin());
    writer.commit();
  }
  writer.finish(std::vector<Telemetry>(robots.size()));
  return path;
}

Robot triangle(const std::string& name) {
  Robot robot;
  robot.name = name;
  robot.masses = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}};
  robot.springs = {{0, 1, 1, 0.1f}, {0, 2, 1, 0.1f}, {1, 2, 2, 0.14f}};
  robot.faces = {{0, 1, 2}};
  return robot;
}

std::string recording_of(const std::vector<Robot>& robots, int deflate, bool finished) {
  std::vector<const Robot*> pointers;
  std::vector<Material> materials;
  for (const Robot& robot : robots) {
    pointers.push_back(&robot);
    const auto table = materials_of(robot);
    materials.insert(materials.end(), table.begin(), table.end());
    materials.resize(pointers.size() * max_materials);
  }
  const std::string path = scratch_folder() + "/seed.h5";
  const bool brains = std::ranges::any_of(robots, [](const Robot& robot) { return robot.brain.has_value(); });
  TrajectoryWriter writer(path,
                          {.device_name = "CPU", .seed = 1, .brains = brains, .deflate = deflate, .flush_period = 0},
                          pointers, materials, "seed");
  for (std::int64_t i = 0; i < 3; ++i) {
    const TrajectoryWriter::Frame frame = writer.add(10 * i, 0.1 * static_cast<double>(i));
    std::ranges::fill(frame.positions, Vec3{1, 2, static_cast<float>(i)});
    std::ranges::fill(frame.velocities, Vec3{});
    std::ranges::fill(frame.senses, 0.5f);
    std::ranges::fill(frame.neurons, static_cast<float>(i));
    writer.commit();
  }
  if (!finished)
    for (const auto& entry : std::filesystem::directory_iterator(scratch_folder()))
      if (entry.path().extension() == ".part") return content_of(entry.path());
  writer.finish(std::vector<Telemetry>(robots.size()));
  return content_of(path);
}

}  // namespace

void check_recording(std::string_view input) {
  TrajectoryReader reader(scratch_file(input, "input.h5"));
  validate(reader.configuration());
  for (const RecordedRobot& recorded : reader.robots()) validate(recorded.robot);
  const std::size_t frames = std::min(reader.frames(), most_frames);
  for (std::size_t i = 0; i < frames; ++i) {
    reader.positions(i);
    reader.velocities(i);
    reader.senses(i);
    reader.neurons(i);
    reader.state(i);
  }
  TrajectoryReader again(written_again(reader, frames));
  require(again.configuration() == reader.configuration(), "the configuration does not read back as it was written");
  require(again.robots().size() == reader.robots().size(), "robots are lost");
  for (std::size_t i = 0; i < reader.robots().size(); ++i)
    require(again.robots()[i].robot == reader.robots()[i].robot, "a robot does not read back as it was written");
  for (std::size_t i = 0; i < frames; ++i) {
    require(again.step(i) == reader.step(i) && again.time(i) == reader.time(i), "a time does not read back");
    require(same_bits(copy(again.positions(i)), reader.positions(i)), "positions do not read back");
    require(same_bits(copy(again.velocities(i)), reader.velocities(i)), "velocities do not read back");
    require(same_bits(copy(again.senses(i)), reader.senses(i)), "senses do not read back");
    require(same_bits(copy(again.neurons(i)), reader.neurons(i)), "neurons do not read back");
  }
}

std::vector<std::string> recording_seeds() {
  Robot own = triangle("own");
  own.materials = {{}, {30, 0.2f, 3, 0.5f}, {70, 0, 0, 0}};
  own.material_names = {"air", "fast muscle", "cord"};
  own.actuators = {{"both", {2, 1}}};
  Robot points = triangle("points");
  points.materials = {{}, {30, 0.2f, 3, 0.5f, true, 0.02f}, {70, 0, 0, 0}};
  points.mass = {0.5f, 1, 3};
  points.velocity = {{}, {0, 0, 0.25f}, {0.1f, 0, 0}};
  points.fixed = {2, 0};
  own.origin = R"({"kind":"voxel","size":[1,1,1],"edge":0.1,"cells":[1],"ancestry":{"parents":["a","b"]}})";
  Robot thinker = own;
  thinker.sensors = {{.kind = SensorKind::up}};
  thinker.brain.emplace().layers = {
      {.name = "gate", .neurons = 1, .activation = Activation::sigmoid},
      {.name = "motor", .neurons = 1, .inputs = {{.from = "senses", .weights = {1, 2, 3}}}, .gate = "gate"}};
  return {recording_of({triangle("a"), thinker}, 0, true),
          recording_of({points}, 0, true),
          recording_of({triangle("a")}, 0, true),
          recording_of({triangle("a"), own}, 0, true),
          recording_of({own}, 1, true),
          recording_of({own}, 0, false)};
}

}  // namespace mercury::fuzz
