// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

#include "app/recording/trajectory_hdf5_reading.h"
#include "app/recording/trajectory_layout.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

using namespace hdf5;

Configuration read_configuration(hid_t parameters) {
  const auto read = [&]<class Value>(const auto& parameter, Value& value) {
    const std::string name(parameter.name);
    if constexpr (std::is_same_v<Value, Vec3>) {
      const auto [x, y, z] = read_attributes<float, 3>(parameters, name);
      value = {x, y, z};
    } else if constexpr (std::is_same_v<Value, bool>) {
      value = read_attribute<std::uint8_t>(parameters, name) != 0;
    } else {
      value = read_attribute<Value>(parameters, name);
    }
  };
  Configuration configuration;
  configuration.device = device_named(read_text(parameters, "device"));
  for_each_parameter(configuration.device, read);
  configuration.solver = solver_named(read_text(parameters, "solver"));
  for_each_parameter(configuration, read);
  configuration.environment = environment_named(read_text(parameters, "environment"));
  // A program that is older than a parameter did not record it. The default gives what that program simulated.
  for_each_parameter(configuration.environment, [&](const auto& parameter, auto& value) {
    if (has_attribute(parameters, std::string(parameter.name))) read(parameter, value);
  });
  validate(configuration);
  return configuration;
}

std::vector<Spring> read_springs(hid_t robot) {
  const auto ends = read_rows<std::array<std::uint16_t, 2>>(robot, "springs", H5T_NATIVE_UINT16, {2});
  const auto materials = read_rows<MaterialId>(robot, "spring_material", H5T_NATIVE_UINT8, {});
  const auto rest_lengths = read_rows<float>(robot, "spring_rest_length", H5T_NATIVE_FLOAT, {});
  if (materials.size() != ends.size() || rest_lengths.size() != ends.size())
    throw Error("springs, spring_material and spring_rest_length differ in length");
  std::vector<Spring> springs(ends.size());
  for (std::size_t i = 0; i < springs.size(); ++i) springs[i] = {ends[i][0], ends[i][1], materials[i], rest_lengths[i]};
  return springs;
}

// Reads a field that not every table has: older programs and tables that need none lack it.
template <class Value>
void read_field(hid_t group, const char* name, hid_t type_of_value, std::vector<Material>& materials,
                Value Material::*field) {
  const Handle type(H5Dget_type(open_dataset(group, "materials")));
  if (H5Tget_class(type) != H5T_COMPOUND || H5Tget_member_index(type, name) < 0) {
    H5Eclear2(H5E_DEFAULT);
    return;
  }
  using Read = std::conditional_t<std::is_same_v<Value, bool>, std::uint8_t, Value>;
  const Handle one(H5Tcreate(H5T_COMPOUND, sizeof(Read)));
  checked(H5Tinsert(one, name, 0, type_of_value));
  const auto values = read_rows<Read>(group, "materials", one, {});
  for (std::size_t i = 0; i < materials.size(); ++i) materials[i].*field = static_cast<Value>(values[i]);
}

// A robot without materials of its own has the default table, so a table that equals it is dropped.
void read_materials(hid_t group, Robot& robot) {
  for (const auto& [stiffness, amplitude, frequency, phase] :
       read_rows<std::array<float, 4>>(group, "materials", material_type({}), {}))
    robot.materials.push_back({stiffness, amplitude, frequency, phase});
  read_field(group, "half_wave", H5T_NATIVE_UINT8, robot.materials, &Material::half_wave);
  read_field(group, "relaxation_time", H5T_NATIVE_FLOAT, robot.materials, &Material::relaxation_time);
  if (has_member(group, "material_names")) robot.material_names = read_texts_dataset(group, "material_names");
  const auto has_default_name = [&, id = 0](const std::string& name) mutable {
    return name == default_material_name(static_cast<MaterialId>(id++));
  };
  if (std::ranges::equal(robot.materials, default_materials()) &&
      std::ranges::all_of(robot.material_names, has_default_name)) {
    robot.materials.clear();
    robot.material_names.clear();
  }
}

// Where every mass is 1 kg because the robot says nothing else, the file has no values of its own.
void read_points(hid_t group, Robot& robot) {
  if (has_member(group, "mass")) {
    const Handle dataset = open_dataset(group, "mass");
    if (extent_of(dataset) != Extent{robot.masses.size()}) throw Error("\"mass\" has another shape than its masses");
    robot.mass.resize(robot.masses.size());
    read_dataset(dataset, H5T_NATIVE_FLOAT, robot.mass.data());
    const bool all_one = std::ranges::all_of(robot.mass, [](float mass) { return mass == 1; });
    if (all_one && H5Dget_storage_size(dataset) == 0) robot.mass.clear();
  }
  if (has_member(group, "start_velocity"))
    robot.velocity = read_rows<Vec3>(group, "start_velocity", H5T_NATIVE_FLOAT, {3});
  if (has_member(group, "fixed")) robot.fixed = read_rows<std::uint16_t>(group, "fixed", H5T_NATIVE_UINT16, {});
}

void read_actuators(hid_t group, Robot& robot) {
  if (!has_member(group, "actuators")) return;
  for (std::string& name : read_texts_dataset(group, "actuators"))
    robot.actuators.push_back({.name = std::move(name), .materials = {}});
  for (const auto& [actuator, material] :
       read_rows<std::array<std::uint8_t, 2>>(group, "actuator_materials", H5T_NATIVE_UINT8, {2})) {
    if (actuator >= robot.actuators.size())
      throw Error("\"actuator_materials\" names actuator " + std::to_string(actuator) + " of " +
                  std::to_string(robot.actuators.size()));
    robot.actuators[actuator].materials.push_back(material);
  }
}

template <class Value>
std::size_t last_not_above(const std::vector<Value>& rising, Value value) {
  const auto after = std::upper_bound(rising.begin(), rising.end(), value);
  return after == rising.begin() ? 0 : static_cast<std::size_t>(after - rising.begin()) - 1;
}

std::size_t chunk_length(hid_t dataset) {
  const Handle properties(H5Dget_create_plist(dataset));
  if (H5Pget_layout(properties) != H5D_CHUNKED) return 1;
  Extent chunk(H5S_MAX_RANK, 1);
  checked(H5Pget_chunk(properties, H5S_MAX_RANK, chunk.data()));
  return std::max<std::size_t>(1, chunk[0]);
}

}  // namespace

template <class Work>
auto TrajectoryReader::guarded(const Work& work) const {
  try {
    return work();
  } catch (const Error& error) {
    throw InputError(path_.string(), error.number() != 0 ? std::strerror(error.number()) : error.what());
  } catch (const InputError& error) {
    throw InputError(path_.string(), error.what());
  }
}

TrajectoryReader::TrajectoryReader(const std::filesystem::path& path, const WorkWatch& watch) : path_(path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path.string(), "is a folder, not a trajectory");
  // Opening a FIFO would wait for a writer.
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw InputError(path.string(), "is not a regular file, as a trajectory must be");
  guarded([&] {
    file_ = open_file(path, unfinished_);
    if (!has_member(file_, "h5md") || !has_member(file_, "parameters") || !has_member(file_, "particles"))
      throw Error("is not a trajectory that mercury recorded");
    read_parameters();
    read_robots(watch);
  });
}

void TrajectoryReader::read_parameters() {
  const Handle h5md = open_group(file_, "h5md"), parameters = open_group(file_, "parameters");
  if (read_attributes<std::int32_t, 2>(h5md, "version")[0] != h5md_version[0])
    throw Error("is not of H5MD's version 1");
  if (!has_attribute(parameters, "format")) throw Error("is not a trajectory that mercury recorded");
  if (const int format = read_attribute<std::int32_t>(parameters, "format"); format != trajectory_format)
    throw Error("is a trajectory of format " + std::to_string(format) + "; this program reads format " +
                std::to_string(trajectory_format));
  const Handle creator = open_group(h5md, "creator");
  program_ = read_text(creator, "name") + " " + read_text(creator, "version");
  device_name_ = read_text(parameters, "device_name");
  if (has_attribute(parameters, "seed")) seed_ = read_attribute<std::uint64_t>(parameters, "seed");
  every_ = read_attribute<std::int64_t>(parameters, "every");
  configuration_ = read_configuration(parameters);
  if (has_attribute(parameters, "frame_rate")) {
    frame_rate_ = read_attribute<double>(parameters, "frame_rate");
    if (!(*frame_rate_ > 0 && *frame_rate_ * configuration_.dt <= 1.000001))
      throw Error("its frame_rate is out of range");
  }
  if (unfinished_) {
    read_unfinished_times(parameters);
  } else {
    steps_ = read_rows<std::int64_t>(parameters, "step", H5T_NATIVE_INT64, {});
    times_ = read_rows<double>(parameters, "time", H5T_NATIVE_DOUBLE, {});
  }
  if (steps_.size() != times_.size()) throw Error("step and time differ in length");
  for (std::size_t i = 0; i < times_.size(); ++i)
    if (!std::isfinite(times_[i]) || (i > 0 && !(times_[i] > times_[i - 1] && steps_[i] > steps_[i - 1])))
      throw Error("the times of its frames do not grow");
  if (!steps_.empty() && steps_.front() < 0) throw Error("the steps of its frames are negative");
  if (frame_rate_) {
    const FramePlaces places = this->places();
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (places.of(static_cast<std::int64_t>(i)).step != steps_[i])
        throw Error("the steps of its frames are not those of its frame_rate");
  }
  read_base(parameters);
}

// The program that writes the file may be ahead with one of the two.
void TrajectoryReader::read_unfinished_times(hid_t parameters) {
  const Handle step = open_dataset(parameters, "step"), time = open_dataset(parameters, "time");
  const Extent steps = extent_of(step), times = extent_of(time);
  if (steps.size() != 1 || times.size() != 1) throw Error("step or time has another shape");
  const Extent extent{std::min(steps[0], times[0])};
  const std::size_t frames = extent[0];
  if (frames == 0) return;
  for (const hid_t dataset : {hid_t{step}, hid_t{time}}) {
    require_content(dataset, frames * sizeof(double));
    require_chunks(dataset, 0, frames);
  }
  const Handle all = space_of(extent);
  const auto read = [&](hid_t dataset, hid_t type, void* content) {
    const Handle stored(H5Dget_space(dataset));
    checked(H5Sselect_hyperslab(stored, H5S_SELECT_SET, Extent{0}.data(), nullptr, extent.data(), nullptr));
    read_last_rows(dataset, type, all, stored, content);
  };
  steps_.resize(frames);
  times_.resize(frames);
  read(step, H5T_NATIVE_INT64, steps_.data());
  read(time, H5T_NATIVE_DOUBLE, times_.data());
}

void TrajectoryReader::require_chunks(hid_t dataset, std::size_t first, std::size_t count) const {
  std::error_code error;
  const std::uintmax_t file_size = std::filesystem::file_size(path_, error);
  if (error) throw Error(error.message());
  const std::size_t length = chunk_length(dataset);
  for (std::size_t row = first; row < first + count; row = row - row % length + length)
    require_chunk(dataset, row, file_size);
}

void TrajectoryReader::read_robots(const WorkWatch& watch) {
  particles_ = open_group(file_, "particles");
  if (has_member(file_, "observables")) observables_ = open_group(file_, "observables");
  const std::vector<std::string> groups = members(particles_);
  if (groups.empty()) throw Error("holds no robots");
  robots_.resize(groups.size());
  std::size_t done = 0;
  for (const std::string& name : groups) {
    const Handle group = open_group(particles_, name);
    const std::uint64_t index = read_attribute<std::uint64_t>(group, "index");
    if (index >= groups.size() || !robots_[index].group.empty())
      throw Error("the indices of its robots are not 0, 1, 2, ...");
    try {
      robots_[index] = read_robot(name, group);
      const std::size_t masses = robots_[index].robot.masses.size();
      for (const char* element : {"position", "velocity"}) require_frames(group, element, {masses, 3});
      chunk_ = std::max(chunk_, chunk_length(open_dataset(open_group(group, "position"), "value")));
    } catch (const std::runtime_error& error) {
      throw Error("/particles/" + name + ": " + error.what());
    }
    if (watch) watch("reading the recording", ++done, groups.size());
  }
  for (const RecordedRobot& recorded : robots_) {
    positions_.offsets.push_back(positions_.width() + recorded.robot.masses.size());
    read_brains(recorded.group, recorded.robot);
  }
  velocities_.offsets = robot_positions_.offsets = robot_velocities_.offsets = positions_.offsets;
  robot_senses_.offsets = senses_.offsets;
  robot_neurons_.offsets = neurons_.offsets;
}

// Earlier versions recorded none.
void TrajectoryReader::read_brains(const std::string& name, const Robot& robot) {
  std::size_t senses = 0, neurons = 0;
  if (robot.brain && observables_ >= 0 && has_member(observables_, name)) {
    try {
      const Handle group = open_group(observables_, name);
      const BrainLayout layout = brain_layout(robot);
      senses = layout.senses.size();
      neurons = layout.neurons.size();
      if (senses > 0) require_frames(group, "senses", {senses});
      if (neurons > 0) require_frames(group, "neurons", {neurons});
    } catch (const std::runtime_error& error) {
      throw Error("/observables/" + name + ": " + error.what());
    }
  }
  senses_.offsets.push_back(senses_.width() + senses);
  neurons_.offsets.push_back(neurons_.width() + neurons);
}

RecordedRobot TrajectoryReader::read_robot(const std::string& name, hid_t group) const {
  RecordedRobot recorded{.group = name};
  Robot& robot = recorded.robot;
  robot.name = read_text(group, "name");
  robot.masses = read_rows<Vec3>(group, "rest_position", H5T_NATIVE_FLOAT, {3});
  read_points(group, robot);
  robot.springs = read_springs(group);
  robot.faces = read_rows<Face>(group, "faces", H5T_NATIVE_UINT16, {3});
  read_materials(group, robot);
  read_actuators(group, robot);
  if (has_member(group, "origin")) robot.origin = read_text_dataset(group, "origin");
  if (has_member(group, "sensors")) set_sensors(robot, read_text_dataset(group, "sensors"));
  if (has_member(group, "brain")) set_brain(robot, read_text_dataset(group, "brain"));
  validate(robot);
  if (has_attribute(group, "exploded_at")) recorded.exploded_at = read_attribute<double>(group, "exploded_at");
  if (has_attribute(group, "first_bad_spring"))
    recorded.culprit_spring = read_attribute<std::uint32_t>(group, "first_bad_spring");
  return recorded;
}

void TrajectoryReader::require_frames(hid_t robot, const char* element, const std::vector<std::size_t>& row) const {
  Extent extent = extent_of(open_dataset(open_group(robot, element), "value"));
  if (unfinished_ && !extent.empty()) extent[0] = std::min<hsize_t>(extent[0], steps_.size());  // it may be ahead
  Extent wanted{steps_.size()};
  wanted.insert(wanted.end(), row.begin(), row.end());
  if (extent != wanted)
    throw Error(std::string(element) + "/value has another shape than its robot and the file's frames");
}

// A clock that does not agree with the first frame is not that of its simulation: an older program did not record it.
void TrajectoryReader::read_base(hid_t parameters) {
  base_ = {.dt = configuration_.dt};
  if (steps_.empty()) return;
  if (has_attribute(parameters, "base_step"))
    base_ = {.dt = configuration_.dt,
             .base_time = read_attribute<double>(parameters, "base_time"),
             .base_step = read_attribute<std::int64_t>(parameters, "base_step")};
  if (!std::isfinite(base_.base_time) || base_.base_step < 0 || steps_.front() < base_.base_step)
    throw Error("its base_time or base_step is out of range");
  base_.step = steps_.front();
  if (time_of(base_) != times_.front())
    base_ = {.dt = configuration_.dt, .base_time = times_.front(), .base_step = steps_.front()};
}

FramePlaces TrajectoryReader::places() const {
  const std::int64_t first = steps_.empty() ? 0 : steps_.front();
  return frame_rate_ ? FramePlaces(first, *frame_rate_, configuration_.dt) : FramePlaces(first, every_);
}

Clock TrajectoryReader::clock(std::size_t frame) const {
  Clock clock = base_;
  clock.step = step(frame);
  return clock;
}

BatchState TrajectoryReader::state(std::size_t frame) {
  BatchState state{.clock = clock(frame), .positions = {}, .velocities = {}, .explosions = {}, .brains = {}};
  const auto copied = [](std::span<const Vec3> values) { return std::vector<Vec3>(values.begin(), values.end()); };
  state.positions = copied(positions(frame));
  state.velocities = copied(velocities(frame));
  for (std::size_t i = 0; i < robots_.size(); ++i)
    if (const auto& at = robots_[i].exploded_at; at && *at < time(frame))
      state.explosions.push_back({i, state.clock.step, *at, robots_[i].culprit_spring.value_or(no_spring)});
  if (has_brains()) add_brains(state, frame);
  return state;
}

void TrajectoryReader::add_brains(BatchState& state, std::size_t frame) {
  if (brains_at_start_.empty())
    for (const RecordedRobot& recorded : robots_) brains_at_start_.push_back(brain_at_start(recorded.robot));
  state.brains = brains_at_start_;
  const auto copy = [](const Block<float>& block, std::span<const float> values, std::size_t robot,
                       std::vector<float>& to) {
    std::ranges::copy(values.subspan(block.offsets[robot], block.width(robot)), to.begin());
  };
  const std::span<const float> senses = this->senses(frame), neurons = this->neurons(frame);
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    copy(senses_, senses, i, state.brains[i].senses);
    copy(neurons_, neurons, i, state.brains[i].neurons);
  }
}

std::size_t TrajectoryReader::frame_at(double time) const { return last_not_above(times_, time); }
std::size_t TrajectoryReader::frame_of_step(std::int64_t step) const { return last_not_above(steps_, step); }

template <class Value>
TrajectoryReader::Block<Value>& TrajectoryReader::of_robot(Block<Value>& block, std::size_t robot) {
  if (block.robot != robot) block.count = 0;
  block.robot = robot;
  return block;
}

template <class Value>
std::size_t TrajectoryReader::length_of(const Block<Value>& block) const {
  const std::size_t width = block.robot == all_robots ? block.width() : block.width(block.robot);
  return std::clamp<std::size_t>(held_bytes / (sizeof(Value) * width), 1, chunk_);
}

template <class Value>
std::span<const Value> TrajectoryReader::read(Block<Value>& block, std::size_t frame) {
  if (frame >= frames()) throw std::out_of_range("frame " + std::to_string(frame) + " of " + std::to_string(frames()));
  const std::size_t width = block.robot == all_robots ? block.width() : block.width(block.robot);
  if (width == 0) return {};
  if (frame < block.first || frame >= block.first + block.count)
    guarded([&] { read_block(block, frame - frame % length_of(block)); });
  return std::span(std::as_const(block.values)).subspan((frame - block.first) * width, width);
}

template <class Value>
void TrajectoryReader::read_block(Block<Value>& block, std::size_t first) {
  block.count = 0;  // none, in case reading throws
  const bool all = block.robot == all_robots;
  const std::size_t first_robot = all ? 0 : block.robot, last_robot = all ? robots_.size() : block.robot + 1;
  const std::size_t count = std::min(length_of(block), frames() - first),
                    width = block.offsets[last_robot] - block.offsets[first_robot];
  const auto extent_of_frames = [&](hsize_t frames, hsize_t values) {
    return std::is_same_v<Value, Vec3> ? Extent{frames, values, 3} : Extent{frames, values};
  };
  const hid_t parent = std::is_same_v<Value, Vec3> ? particles_ : observables_;
  const Extent held_extent = extent_of_frames(count, width);
  block.values.resize(count * width);
  for (std::size_t i = first_robot; i < last_robot; ++i) {
    if (block.width(i) == 0) continue;
    const Handle dataset = open_dataset(open_group(open_group(parent, robots_[i].group), block.element), "value");
    const Handle stored(H5Dget_space(dataset)),
        held(H5Screate_simple(static_cast<int>(held_extent.size()), held_extent.data(), nullptr));
    const Extent extent = extent_of_frames(count, block.width(i));
    Extent from(extent.size(), 0), to(extent.size(), 0);
    from[0] = first;
    to[1] = block.offsets[i] - block.offsets[first_robot];
    checked(H5Sselect_hyperslab(stored, H5S_SELECT_SET, from.data(), nullptr, extent.data(), nullptr));
    checked(H5Sselect_hyperslab(held, H5S_SELECT_SET, to.data(), nullptr, extent.data(), nullptr));
    if (unfinished_) require_chunks(dataset, first, count);
    if (unfinished_ && first + count == frames())
      read_last_rows(dataset, H5T_NATIVE_FLOAT, held, stored, block.values.data());
    else
      checked(H5Dread(dataset, H5T_NATIVE_FLOAT, held, stored, H5P_DEFAULT, block.values.data()));
  }
  block.first = first;
  block.count = count;
}

// What the members in the header use.
template std::span<const Vec3> TrajectoryReader::read(Block<Vec3>&, std::size_t);
template std::span<const float> TrajectoryReader::read(Block<float>&, std::size_t);
template TrajectoryReader::Block<Vec3>& TrajectoryReader::of_robot(Block<Vec3>&, std::size_t);
template TrajectoryReader::Block<float>& TrajectoryReader::of_robot(Block<float>&, std::size_t);

}  // namespace mercury
