// SPDX-License-Identifier: Apache-2.0
#include "app/recording/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "app/base/progress.h"
#include "app/recording/trajectory_hdf5_reading.h"
#include "app/recording/trajectory_hdf5_writing.h"
#include "app/recording/trajectory_reader.h"
#include "app/recording/trajectory_writer.h"
#include "mercury/error.h"

namespace mercury {
namespace {

using namespace hdf5;

constexpr std::int32_t checkpoint_version = 1;
constexpr const char* group_name = "checkpoint";

// A robot's sums as a row of doubles: every float and every number of a spring is one exactly.
constexpr std::size_t telemetry_numbers = 14, row_numbers = 2 * telemetry_numbers + 5;
using Row = std::array<double, row_numbers>;

void append(const Telemetry& telemetry, double*& out) {
  for (const Vec3 v : {telemetry.center_of_mass, telemetry.velocity})
    for (const float number : {v.x, v.y, v.z}) *out++ = static_cast<double>(number);
  for (const double number :
       {telemetry.kinetic_energy, telemetry.elastic_energy, telemetry.muscle_power,
        static_cast<double>(telemetry.largest_strain), static_cast<double>(telemetry.strained_share),
        telemetry.exploded ? 1.0 : 0.0, telemetry.exploded_at, static_cast<double>(telemetry.culprit_spring)})
    *out++ = number;
}

Row row_of(const TrialMeasures::Sums& sums) {
  Row row{};
  double* out = row.data();
  append(sums.start, out);
  append(sums.last, out);
  for (const double number : {sums.path, sums.work, sums.highest, sums.largest_strain, sums.strained_share})
    *out++ = number;
  return row;
}

float float_of(double number) {
  if (std::isfinite(number) && std::abs(number) > static_cast<double>(std::numeric_limits<float>::max()))
    throw Error("/checkpoint/measures: a number is out of range");
  return static_cast<float>(number);
}

Telemetry telemetry_from(const double*& in) {
  Telemetry telemetry;
  for (Vec3* v : {&telemetry.center_of_mass, &telemetry.velocity})
    for (float Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) v->*axis = float_of(*in++);
  telemetry.kinetic_energy = *in++;
  telemetry.elastic_energy = *in++;
  telemetry.muscle_power = *in++;
  telemetry.largest_strain = float_of(*in++);
  telemetry.strained_share = float_of(*in++);
  telemetry.exploded = *in++ != 0;
  telemetry.exploded_at = *in++;
  const double spring = *in++;
  if (!(spring >= 0 && spring <= static_cast<double>(no_spring)))
    throw Error("/checkpoint/measures: a spring is out of range");
  telemetry.culprit_spring = static_cast<std::uint32_t>(spring);
  return telemetry;
}

TrialMeasures::Sums sums_from(const Row& row) {
  const double* in = row.data();
  TrialMeasures::Sums sums;
  sums.start = telemetry_from(in);
  sums.last = telemetry_from(in);
  for (double TrialMeasures::Sums::*number :
       {&TrialMeasures::Sums::path, &TrialMeasures::Sums::work, &TrialMeasures::Sums::highest,
        &TrialMeasures::Sums::largest_strain, &TrialMeasures::Sums::strained_share})
    sums.*number = *in++;
  return sums;
}

// The way of each robot. Earlier versions wrote none.
void write_ways(hid_t parent, std::span<const TrialMeasures::Sums> measures) {
  if (measures.empty() || measures.front().way.empty()) return;
  const TrialMeasures::Sums& first = measures.front();  // all have as many samples, at the same times
  const Handle group = create_group(parent, "ways");
  write_attribute(group, "elapsed", first.elapsed);
  write_attribute(group, "period", first.period);
  write_attribute(group, "samples", first.samples);
  write_attribute(group, "stride", first.stride);
  std::vector<float> places;
  for (const TrialMeasures::Sums& sums : measures)
    for (const Vec3& place : sums.way) places.insert(places.end(), {place.x, place.y, place.z});
  write_dataset(group, "place", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {measures.size() * first.way.size(), 3},
                places.data());
}

void read_ways(hid_t parent, std::span<TrialMeasures::Sums> measures) {
  if (measures.empty() || !has_member(parent, "ways")) return;
  const Handle group = open_group(parent, "ways");
  TrialMeasures::Sums common;
  common.elapsed = read_attribute<double>(group, "elapsed");
  common.period = read_attribute<double>(group, "period");
  common.samples = read_attribute<std::int64_t>(group, "samples");
  common.stride = read_attribute<std::int64_t>(group, "stride");
  const auto places = read_rows<std::array<float, 3>>(group, "place", H5T_NATIVE_FLOAT, {3});
  const std::size_t count = places.size() / measures.size();
  const bool fits = count * measures.size() == places.size() && count >= 1 && count <= TrialMeasures::longest_way &&
                    common.samples >= 0 && common.stride >= 1 &&
                    common.samples / common.stride == static_cast<std::int64_t>(count) - 1 && common.elapsed >= 0 &&
                    common.elapsed < 1e18 && common.period >= 0 && common.period < 1e18;
  if (!fits) throw Error("/checkpoint/ways: its numbers do not go together");
  for (std::size_t i = 0; i < measures.size(); ++i) {
    measures[i].elapsed = common.elapsed;
    measures[i].period = common.period;
    measures[i].samples = common.samples;
    measures[i].stride = common.stride;
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [x, y, z] = places[i * count + k];
      measures[i].way.push_back({x, y, z});
    }
  }
}

// Of the robots of a run that measures folding. The telemetry at the start and at the last sample has none: nothing
// that derives from the samples uses it.
void write_foldings(hid_t parent, std::span<const TrialMeasures::Sums> measures) {
  if (std::ranges::all_of(measures, [](const auto& sums) { return std::isnan(sums.inverted); })) return;
  std::vector<double> numbers;
  for (const TrialMeasures::Sums& sums : measures) numbers.insert(numbers.end(), {sums.inverted, sums.overlap});
  write_dataset(parent, "foldings", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {measures.size(), 2}, numbers.data());
}

void read_foldings(hid_t parent, std::span<TrialMeasures::Sums> measures) {
  if (!has_member(parent, "foldings")) return;
  const auto rows = read_rows<std::array<double, 2>>(parent, "foldings", H5T_NATIVE_DOUBLE, {2});
  if (rows.size() != measures.size()) throw Error("/checkpoint/foldings: it has another length than measures");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    measures[i].inverted = rows[i][0];
    measures[i].overlap = rows[i][1];
  }
}

// Of the robots of a run that measures it. Unlike folding, it needs the values at the start and at the last sample.
void write_uprights(hid_t parent, std::span<const TrialMeasures::Sums> measures) {
  if (std::ranges::all_of(measures, [](const auto& sums) { return std::isnan(sums.start.upright); })) return;
  std::vector<double> numbers;
  for (const TrialMeasures::Sums& sums : measures)
    numbers.insert(numbers.end(), {static_cast<double>(sums.start.upright), static_cast<double>(sums.last.upright),
                                   sums.upright, sums.upright_seconds});
  write_dataset(parent, "uprights", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {measures.size(), 4}, numbers.data());
}

void read_uprights(hid_t parent, std::span<TrialMeasures::Sums> measures) {
  if (!has_member(parent, "uprights")) return;
  const auto rows = read_rows<std::array<double, 4>>(parent, "uprights", H5T_NATIVE_DOUBLE, {4});
  if (rows.size() != measures.size()) throw Error("/checkpoint/uprights: it has another length than measures");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    measures[i].start.upright = float_of(rows[i][0]);
    measures[i].last.upright = float_of(rows[i][1]);
    measures[i].upright = rows[i][2];
    measures[i].upright_seconds = rows[i][3];
  }
}

// Earlier versions wrote none: they are unknown then.
constexpr std::pair<const char*, double TrialMeasures::Sums::*> later_numbers[] = {
    {"positive_work", &TrialMeasures::Sums::positive_work}, {"nearest", &TrialMeasures::Sums::nearest}};

void write_later_numbers(hid_t parent, std::span<const TrialMeasures::Sums> measures) {
  for (const auto& [name, member] : later_numbers) {
    std::vector<double> numbers;
    for (const TrialMeasures::Sums& sums : measures) numbers.push_back(sums.*member);
    write_dataset(parent, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {numbers.size()}, numbers.data());
  }
}

void read_later_numbers(hid_t parent, std::span<TrialMeasures::Sums> measures) {
  for (const auto& [name, member] : later_numbers) {
    std::vector<double> numbers(measures.size(), std::numeric_limits<double>::quiet_NaN());
    if (has_member(parent, name)) numbers = read_rows<double>(parent, name, H5T_NATIVE_DOUBLE, {});
    if (numbers.size() != measures.size())
      throw Error(fmt::format("/checkpoint/{}: it has another length than measures", name));
    for (std::size_t i = 0; i < measures.size(); ++i) measures[i].*member = numbers[i];
  }
}

// The states of all brains, robot after robot. Earlier versions wrote none.
void write_brain_states(hid_t parent, const Simulation& simulation) {
  if (!simulation.has_brains()) return;
  BrainState all;
  std::vector<std::uint64_t> thoughts;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const BrainState state = simulation.brain_state(i);
    for (const auto numbers : {&BrainState::neurons, &BrainState::senses, &BrainState::weights})
      (all.*numbers).insert((all.*numbers).end(), (state.*numbers).begin(), (state.*numbers).end());
    thoughts.push_back(state.thoughts);
  }
  const Handle group = create_group(parent, "brains");
  const auto write = [&](const char* name, const std::vector<float>& numbers) {
    write_dataset(group, name, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {numbers.size()}, numbers.data());
  };
  write("neurons", all.neurons);
  write("senses", all.senses);
  write("weights", all.weights);
  write_dataset(group, "thoughts", H5T_STD_U64LE, H5T_NATIVE_UINT64, {thoughts.size()}, thoughts.data());
}

std::vector<BrainState> read_brain_states(hid_t parent, std::span<const RecordedRobot> robots) {
  if (!has_member(parent, "brains")) return {};
  const Handle group = open_group(parent, "brains");
  std::vector<BrainState> states;
  for (const RecordedRobot& recorded : robots) states.push_back(brain_at_start(recorded.robot));
  const auto read = [&](const char* name, std::vector<float> BrainState::*numbers) {
    const auto all = read_rows<float>(group, name, H5T_NATIVE_FLOAT, {});
    auto next = all.begin();
    for (BrainState& state : states) {
      std::vector<float>& own = state.*numbers;
      if (static_cast<std::size_t>(all.end() - next) < own.size())
        throw Error(fmt::format("/checkpoint/brains/{}: it is shorter than the robots' brains", name));
      std::copy_n(next, own.size(), own.begin());
      next += static_cast<std::ptrdiff_t>(own.size());
    }
    if (next != all.end())
      throw Error(fmt::format("/checkpoint/brains/{}: it is longer than the robots' brains", name));
  };
  read("neurons", &BrainState::neurons);
  read("senses", &BrainState::senses);
  read("weights", &BrainState::weights);
  const auto thoughts = read_rows<std::uint64_t>(group, "thoughts", H5T_NATIVE_UINT64, {});
  if (thoughts.size() != states.size())
    throw Error("/checkpoint/brains/thoughts: it has another length than the robots");
  for (std::size_t i = 0; i < states.size(); ++i) states[i].thoughts = thoughts[i];
  return states;
}

void write_robots(hid_t parent, const std::string& name, std::span<const CheckpointRobot> robots) {
  const Handle group = create_group(parent, name);
  std::vector<std::uint64_t> indices;
  for (const CheckpointRobot& robot : robots) indices.push_back(robot.index);
  write_dataset(group, "index", H5T_STD_U64LE, H5T_NATIVE_UINT64, {indices.size()}, indices.data());
  const auto write = [&](const char* of, std::string CheckpointRobot::*text) {
    std::vector<std::string> texts;
    for (const CheckpointRobot& robot : robots) texts.push_back(robot.*text);
    write_text_dataset(group, of, texts);
  };
  write("name", &CheckpointRobot::name);
  write("file", &CheckpointRobot::file);
  write("random", &CheckpointRobot::random);
  write("failure", &CheckpointRobot::failure);
}

std::vector<CheckpointRobot> read_robots(hid_t parent, const std::string& name) {
  const Handle group = open_group(parent, name);
  const auto indices = read_rows<std::uint64_t>(group, "index", H5T_NATIVE_UINT64, {});
  std::vector<CheckpointRobot> robots(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) robots[i].index = indices[i];
  const auto read = [&](const char* of, std::string CheckpointRobot::*text) {
    std::vector<std::string> texts = read_texts_dataset(group, of);
    if (texts.size() != robots.size()) throw Error(fmt::format("/checkpoint/{}: {} has another length", name, of));
    for (std::size_t i = 0; i < texts.size(); ++i) robots[i].*text = std::move(texts[i]);
  };
  read("name", &CheckpointRobot::name);
  read("file", &CheckpointRobot::file);
  read("random", &CheckpointRobot::random);
  read("failure", &CheckpointRobot::failure);
  return robots;
}

void write_notes(hid_t file, const Simulation& simulation, const CheckpointNotes& notes) {
  const Handle group = create_group(file, group_name);
  write_attribute(group, "version", checkpoint_version);
  write_text(group, "backend", name_of(Device{.kind = backend_of(simulation)}));
  write_attribute(group, "seconds", notes.seconds);
  write_attribute(group, "settle", notes.settle);
  write_attribute(group, "strain_limit", notes.strain_limit);
  write_attribute(group, "sampled", notes.sampled);
  write_attribute(group, "folding", std::uint8_t{notes.folding});
  write_attribute(group, "upright", std::uint8_t{notes.upright});
  write_robots(group, "robots", notes.robots);
  write_robots(group, "failed", notes.failed);
  std::vector<Row> rows;
  for (const TrialMeasures::Sums& sums : notes.measures) rows.push_back(row_of(sums));
  write_dataset(group, "measures", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {rows.size(), row_numbers}, rows.data());
  write_ways(group, notes.measures);
  write_foldings(group, notes.measures);
  write_uprights(group, notes.measures);
  write_later_numbers(group, notes.measures);
  write_brain_states(group, simulation);
  if (!notes.recording) return;
  const Handle recording = create_group(group, "recording");
  write_text(recording, "path", notes.recording->path);
  write_text(recording, "unfinished", notes.recording->unfinished);
  write_attribute(recording, "frames", notes.recording->frames);
  write_attribute(recording, "every", notes.recording->every);
  if (notes.recording->rate) write_attribute(recording, "frame_rate", *notes.recording->rate);
  write_attribute(recording, "compressed", std::uint8_t{notes.recording->compressed});
  write_attribute(recording, "brains", std::uint8_t{notes.recording->brains});
}

void require(bool holds, const char* what) {
  if (!holds) throw Error(std::string("/checkpoint: ") + what);
}

CheckpointNotes read_notes(hid_t group) {
  CheckpointNotes notes{
      .seconds = read_attribute<double>(group, "seconds"),
      .settle = read_attribute<double>(group, "settle"),
      .strain_limit = read_attribute<double>(group, "strain_limit"),
      .folding = has_attribute(group, "folding") && read_attribute<std::uint8_t>(group, "folding") != 0,
      .upright = has_attribute(group, "upright") && read_attribute<std::uint8_t>(group, "upright") != 0,
      .sampled = read_attribute<std::int64_t>(group, "sampled"),
      .robots = read_robots(group, "robots"),
      .failed = read_robots(group, "failed")};
  for (const Row& row : read_rows<Row>(group, "measures", H5T_NATIVE_DOUBLE, {row_numbers}))
    notes.measures.push_back(sums_from(row));
  read_ways(group, notes.measures);
  read_foldings(group, notes.measures);
  read_uprights(group, notes.measures);
  read_later_numbers(group, notes.measures);
  if (!has_member(group, "recording")) return notes;
  const Handle recording = open_group(group, "recording");
  notes.recording = {.path = read_text(recording, "path"),
                     .unfinished = read_text(recording, "unfinished"),
                     .frames = read_attribute<std::int64_t>(recording, "frames"),
                     .every = read_attribute<std::int64_t>(recording, "every"),
                     .compressed = read_attribute<std::uint8_t>(recording, "compressed") != 0};
  if (has_attribute(recording, "brains"))  // of earlier versions without
    notes.recording->brains = read_attribute<std::uint8_t>(recording, "brains") != 0;
  if (has_attribute(recording, "frame_rate")) {
    notes.recording->rate = read_attribute<double>(recording, "frame_rate");
    require(*notes.recording->rate > 0 && std::isfinite(*notes.recording->rate), "its frame_rate is out of range");
  }
  require(notes.recording->frames >= 1 && notes.recording->every >= 1, "the frames of its recording are out of range");
  return notes;
}

void validate_notes(const CheckpointNotes& notes, std::size_t robots, std::int64_t step) {
  const bool fits = notes.sampled < 0 ? notes.measures.empty() : notes.measures.size() == robots;
  require(notes.robots.size() == robots && fits, "its robots and measures differ in number");
  require(notes.sampled >= -1 && notes.sampled <= step, "the step of its last sample is out of range");
  require(std::isfinite(notes.seconds) && notes.seconds >= 0 && std::isfinite(notes.settle) && notes.settle >= 0 &&
              notes.settle <= notes.seconds && notes.strain_limit >= 0,
          "seconds, settle or strain_limit is out of range");
}

}  // namespace

DeviceKind backend_of(const Simulation& simulation) {
  return simulation.device_name().starts_with("CPU") ? DeviceKind::cpu : DeviceKind::cuda;
}

void save_checkpoint(const std::filesystem::path& path, const Simulation& simulation, const CheckpointNotes& notes) {
  std::vector<const Robot*> robots;
  for (std::size_t i = 0; i < simulation.size(); ++i) robots.push_back(&simulation.robot(i));
  TrajectoryWriter writer(path,
                          {.configuration = simulation.configuration(),
                           .device_name = simulation.device_name(),
                           .seed = notes.seed,
                           .expected_frames = 1,
                           .time = simulation.clock(),
                           .more = [&](hid_t file) { write_notes(file, simulation, notes); }},
                          robots, simulation.materials(), "--checkpoint");
  const TrajectoryWriter::Frame frame = writer.add(simulation.steps(), simulation.time());
  simulation.read_positions(frame.positions);
  simulation.read_velocities(frame.velocities);
  writer.commit();
  writer.finish(simulation.telemetry());
}

Checkpoint load_checkpoint(const std::filesystem::path& path) {
  TrajectoryReader reader(path, shown_work());
  Checkpoint checkpoint{.robots = {},
                        .configuration = reader.configuration(),
                        .device_name = reader.device_name(),
                        .state = {},
                        .notes = {}};
  std::vector<BrainState> brains;
  try {
    bool unfinished = false;
    const Handle file = open_file(path, unfinished);
    if (!has_member(file, group_name)) throw Error("is a recording, not a checkpoint of mercury run --checkpoint");
    if (reader.unfinished() || unfinished || reader.frames() != 1) throw Error("is not a complete checkpoint");
    const Handle group = open_group(file, group_name);
    if (const auto version = read_attribute<std::int32_t>(group, "version"); version != checkpoint_version)
      throw Error(
          fmt::format("is a checkpoint of version {}; this program reads version {}", version, checkpoint_version));
    checkpoint.backend = device_named(read_text(group, "backend")).kind;
    checkpoint.notes = read_notes(group);
    checkpoint.notes.seed = reader.seed();
    validate_notes(checkpoint.notes, reader.robots().size(), reader.step(0));
    brains = read_brain_states(group, reader.robots());
  } catch (const Error& error) {
    throw InputError(path.string(), error.what());
  } catch (const InputError& error) {
    throw InputError(path.string(), error.what());
  }
  checkpoint.state = reader.state(0);
  checkpoint.state.brains = std::move(brains);
  for (const RecordedRobot& recorded : reader.robots()) checkpoint.robots.push_back(recorded.robot);
  return checkpoint;
}

}  // namespace mercury
