// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "app/base/version.h"
#include "app/recording/trajectory_hdf5_writing.h"
#include "app/recording/trajectory_layout.h"
#include "mercury/error.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

using namespace hdf5;

static_assert(sizeof(Vec3) == 3 * sizeof(float) && sizeof(Spring) == 12 && sizeof(Face) == 6);

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;  // of one chunk of the largest robot, at most
// A flush in a mode for readers takes time that grows with the square of the number of robots (HDF5 1.10): 0.2 s for
// 2,000, minutes for 20,000.
constexpr std::size_t most_robots_flushed = 2000;
constexpr std::size_t longest_block = 64;  // frames
constexpr hsize_t page_bytes = 4096;       // of the memory in which the kernel keeps files

// The user's name, which H5MD requires.
std::string author() {
  const passwd* user = getpwuid(getuid());
  if (!user) return "unknown";
  const std::string_view real = user->pw_gecos ? user->pw_gecos : "";
  const std::string_view name = real.substr(0, real.find(','));
  return name.empty() ? user->pw_name : std::string(name);
}

// `bytes` = of a frame, `largest` = of a robot's part of one dataset.
std::size_t block_length(std::size_t bytes, std::size_t largest, std::int64_t expected_frames) {
  std::size_t length = std::min({longest_block, held_bytes / bytes, chunk_bytes / largest});
  length = std::max<std::size_t>(1, length);
  if (expected_frames <= 0) return length;
  const auto frames = static_cast<std::size_t>(expected_frames), blocks = (frames - 1) / length + 1;
  return (frames - 1) / blocks + 1;  // equal blocks, so that the last one has little padding
}

Handle create_file(const std::filesystem::path& path, bool survives_kill, WriteFailure& failure) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS));
  // This version of the format has checksums for metadata, so that the reader detects damage.
  checked(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_LATEST));
  set_recording_file(access, failure);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE));
  if (survives_kill) {
    // A program that is killed while it writes leaves whole pages. So no piece of metadata may lie on two pages: half
    // of it would make the file unreadable.
    checked(H5Pset_file_space_strategy(creation, H5F_FSPACE_STRATEGY_PAGE, false, 1));
    checked(H5Pset_file_space_page_size(creation, page_bytes));
  }
  return Handle(H5Fcreate(path.c_str(), H5F_ACC_EXCL, creation, access));
}

// Takes room for the bytes [begin, end) of a file, which stays as long as it is. Disks that cannot do that promise
// nothing.
void reserve(hid_t file, hsize_t begin, hsize_t end) {
  rlimit limit{};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur < end) throw Error("no room", EFBIG);
  void* handle = nullptr;
  checked(H5Fget_vfd_handle(file, H5P_DEFAULT, &handle));
  const int result = fallocate(*static_cast<int*>(handle), FALLOC_FL_KEEP_SIZE, static_cast<off_t>(begin),
                               static_cast<off_t>(end - begin));
  if (result != 0 && errno != EOPNOTSUPP) throw Error("no room", errno);
}

std::string text_of(const Error& error) { return error.number() != 0 ? reason_of(error.number()) : error.what(); }

RecordingFailure write_failure(const std::filesystem::path& path, const std::string& reason, const std::string& kept) {
  return RecordingFailure(path.string() + ": " + reason + "; " + kept);
}

}  // namespace

bool flush_is_due(double since_flush, double last_frame_took, double period) {
  return since_flush >= period || since_flush + last_frame_took >= 2 * period;
}

// Runs work that writes.
template <class Work>
void TrajectoryWriter::guarded(const Work& work) {
  try {
    work();
    require_written();
  } catch (const Error& error) {
    give_up(failure_->number != 0 ? reason_of(failure_->number) : text_of(error));
  }
}

void TrajectoryWriter::require_written() const {
  if (failure_->number != 0) throw Error("a write failed", failure_->number);
}

// The file has the frames of the last flush, as after a kill, or all blocks if there is room left to complete it.
void TrajectoryWriter::give_up(const std::string& reason) {
  failed_ = true;
  const bool complete = reserved_ > 0 && failure_->number == 0 && is_completed();
  if (!complete && failure_->number == 0) failure_->number = EIO;  // nothing more is written
  for (Handle* handle : {&particles_, &connectivity_, &parameters_, &observables_, &file_}) Handle(std::move(*handle));
  if (flushed_ == 0 || !(complete || survives_kill())) throw write_failure(path_, reason, "nothing was kept");
  unfinished_.keep();
  throw write_failure(
      path_, reason,
      flushed_ == 1 ? "the first frame was kept" : fmt::format("the first {} frames were kept", flushed_));
}

bool TrajectoryWriter::is_completed() {
  try {
    announce(written_);
    close();
    require_written();
    flushed_ = written_;
    return true;
  } catch (const Error&) {
    return false;
  }
}

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, const TrajectoryHeader& header,
                                   std::span<const Robot* const> robots, std::span<const Material> materials,
                                   const char* option)
    : path_(path), unfinished_(path), failure_(std::make_unique<WriteFailure>()), deflate_(header.deflate),
      flush_period_(header.flush_period), clock_(header.clock), last_commit_(clock_()), last_flush_(last_commit_) {
  if (!is_trajectory_name(path))
    throw InputError(option, "\"" + path.string() + "\" is not accepted; give a name that ends in .h5, .hdf5 or .h5md");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError(option, path.string() + " is a folder");

  std::vector<std::string> names;
  for (const Robot* robot : robots) {
    names.push_back(robot->name);
    positions_.add_robot(robot->masses.size());
    velocities_.add_robot(robot->masses.size());
    const BrainLayout layout = header.brains ? brain_layout(*robot) : BrainLayout{};
    senses_.add_robot(layout.senses.size());
    neurons_.add_robot(layout.neurons.size());
  }
  groups_ = group_names(names);
  prepare();
  try {
    file_ = create_file(unfinished_.path(), survives_kill(), *failure_);
    require_written();
  } catch (const Error& error) {
    const int number = failure_->number != 0 ? failure_->number : error.number();
    const std::string reason = number != 0 ? reason_of(number) : error.what();
    if (is_fault_of_machine(number)) throw write_failure(path_, reason, "nothing was kept");
    throw InputError(option, path.string() + " cannot be written: " + reason);
  }
  const std::size_t largest =
      std::max({positions_.largest_bytes(), senses_.largest_bytes(), neurons_.largest_bytes(), sizeof(Vec3)});
  hold(block_length(std::max(frame_bytes(), sizeof(Vec3)), largest, header.expected_frames));
  guarded([&] {
    write_header(header);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      write_robot(i, *robots[i], materials.subspan(i * max_materials, materials_of(*robots[i]).size()));
      write_brain_names(i, *robots[i]);
      if (header.watch) header.watch("writing robots", i + 1, robots.size());
    }
    if (header.more) header.more(file_);
  });
  last_commit_ = last_flush_ = clock_();
}

TrajectoryWriter::~TrajectoryWriter() = default;

void TrajectoryWriter::write_header(const TrajectoryHeader& header) {
  const Handle h5md = create_group(file_, "h5md");
  write_attribute(h5md, "version", std::span<const std::int32_t>(h5md_version));
  const Handle author_group = create_group(h5md, "author"), creator = create_group(h5md, "creator");
  write_text(author_group, "name", author());
  const std::string_view program = program_version;  // "mercury 0.1.0"
  write_text(creator, "name", program.substr(0, program.find(' ')));
  write_text(creator, "version", program.substr(program.find(' ') + 1));
  const Handle modules = create_group(h5md, "modules"), units = create_group(modules, "units");
  constexpr std::array<std::int32_t, 2> units_version{1, 0};
  write_attribute(units, "version", std::span<const std::int32_t>(units_version));
  write_unit(units, "SI", "system");

  particles_ = create_ordered_group(file_, "particles");
  connectivity_ = create_ordered_group(file_, "connectivity");
  parameters_ = create_group(file_, "parameters");
  write_attribute(parameters_, "format", std::int32_t{trajectory_format});
  write_attribute(parameters_, "every", header.every);
  if (header.frame_rate) write_attribute(parameters_, "frame_rate", *header.frame_rate);
  if (header.seed) write_attribute(parameters_, "seed", *header.seed);
  if (header.time.base_step != 0 || header.time.base_time != 0) {
    write_attribute(parameters_, "base_step", header.time.base_step);
    write_attribute(parameters_, "base_time", header.time.base_time);
  }
  write_text(parameters_, "device_name", header.device_name);
  write_configuration(parameters_, header.configuration);

  const hsize_t chunk = std::clamp<hsize_t>(static_cast<hsize_t>(header.expected_frames), 1, 1024);
  create_growing(parameters_, "step", H5T_STD_I64LE, {.chunk = chunk});
  write_unit(create_growing(parameters_, "time", H5T_IEEE_F64LE, {.chunk = chunk}), "s");
  write_dataset(parameters_, "materials", material_type({}), material_memory_type({}), {default_materials().size()},
                default_materials().data());
  std::vector<std::string> names;
  for (std::size_t id = 0; id < default_materials().size(); ++id)
    names.push_back(default_material_name(static_cast<MaterialId>(id)));
  write_text_dataset(parameters_, "material_names", names);
}

void TrajectoryWriter::write_configuration(hid_t parameters, const Configuration& configuration) {
  const auto write = [&]<class Value>(const auto& parameter, const Value& value) {
    const std::string name(parameter.name);
    if constexpr (std::is_same_v<Value, Vec3>)
      write_attribute(parameters, name, std::span<const float>(std::array{value.x, value.y, value.z}));
    else if constexpr (std::is_same_v<Value, bool>)
      write_attribute(parameters, name, std::uint8_t{value});
    else
      write_attribute(parameters, name, value);
  };
  write_text(parameters, "device", name_of(configuration.device));
  for_each_parameter(configuration.device, write);
  write_text(parameters, "solver", name_of(configuration.solver));
  for_each_parameter(configuration, write);
  write_text(parameters, "environment", name_of(configuration.environment));
  for_each_parameter(configuration.environment, write);
}

void TrajectoryWriter::write_robot(std::size_t index, const Robot& robot, std::span<const Material> materials) {
  const std::string& name = groups_[index];
  const Handle group = create_group(particles_, name);
  write_text(group, "name", robot.name);
  write_attribute(group, "index", static_cast<std::uint64_t>(index));
  write_text(group, "physics", name_of(physics_of(robot)));
  const Handle box = create_group(group, "box");
  write_attribute(box, "dimension", std::int32_t{3});
  write_texts(box, "boundary", {"none", "none", "none"});
  write_points(group, robot);
  write_unit(write_dataset(group, "rest_position", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {robot.masses.size(), 3},
                           robot.masses.data()),
             "m");
  write_connectivity(name, robot, group);
  write_materials(group, robot, materials);
  write_actuators(group, robot);
  write_brains(group, robot);
  if (!robot.origin.empty()) write_text_dataset(group, "origin", robot.origin);
}

// What the robot says of its masses.
void TrajectoryWriter::write_points(hid_t particles, const Robot& robot) {
  const std::size_t masses = robot.masses.size();
  write_unit(robot.mass.empty()
                 ? write_constant(particles, "mass", 1, {masses})
                 : write_dataset(particles, "mass", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {masses}, robot.mass.data()),
             "kg");
  if (!robot.velocity.empty())
    write_unit(write_dataset(particles, "start_velocity", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {masses, 3},
                             robot.velocity.data()),
               "m s-1");
  if (!robot.fixed.empty())
    write_dataset(particles, "fixed", H5T_STD_U16LE, H5T_NATIVE_UINT16, {robot.fixed.size()}, robot.fixed.data());
}

// Springs and faces where H5MD expects them, with links beside the masses.
void TrajectoryWriter::write_connectivity(const std::string& name, const Robot& robot, hid_t particles) {
  std::vector<std::uint16_t> ends;
  std::vector<MaterialId> materials;
  std::vector<float> rest_lengths;
  for (const Spring& spring : robot.springs) {
    ends.insert(ends.end(), {spring.a, spring.b});
    materials.push_back(spring.material);
    rest_lengths.push_back(spring.rest_length);
  }
  const Handle group = create_group(connectivity_, name);
  const Handle springs =
      write_dataset(group, "springs", H5T_STD_U16LE, H5T_NATIVE_UINT16, {robot.springs.size(), 2}, ends.data());
  const Handle faces =
      write_dataset(group, "faces", H5T_STD_U16LE, H5T_NATIVE_UINT16, {robot.faces.size(), 3}, robot.faces.data());
  write_reference(springs, "particles_group", particles_, name);
  write_reference(faces, "particles_group", particles_, name);
  link(group, "springs", particles, "springs");
  link(group, "faces", particles, "faces");
  write_dataset(particles, "spring_material", H5T_STD_U8LE, H5T_NATIVE_UINT8, {materials.size()}, materials.data());
  write_unit(write_dataset(particles, "spring_rest_length", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {rest_lengths.size()},
                           rest_lengths.data()),
             "m");
}

// All robots with the default materials share one table.
void TrajectoryWriter::write_materials(hid_t particles, const Robot& robot, std::span<const Material> materials) {
  if (std::ranges::equal(materials, default_materials()) && robot.material_names.empty()) {
    link(parameters_, "materials", particles, "materials");
    link(parameters_, "material_names", particles, "material_names");
    return;
  }
  const MaterialFields fields{
      .half_wave = std::ranges::any_of(materials, &Material::half_wave),
      .relaxation_time = std::ranges::any_of(materials, [](const Material& m) { return m.relaxation_time != 0; })};
  write_dataset(particles, "materials", material_type(fields), material_memory_type(fields), {materials.size()},
                materials.data());
  if (!robot.material_names.empty()) write_text_dataset(particles, "material_names", robot.material_names);
}

void TrajectoryWriter::write_actuators(hid_t particles, const Robot& robot) {
  if (robot.actuators.empty()) return;
  std::vector<std::string> names;
  std::vector<std::array<std::uint8_t, 2>> materials;  // actuator and material, in the order of the robot
  for (const Actuator& actuator : robot.actuators) {
    for (const MaterialId id : actuator.materials) materials.push_back({static_cast<std::uint8_t>(names.size()), id});
    names.push_back(actuator.name);
  }
  write_text_dataset(particles, "actuators", names);
  write_dataset(particles, "actuator_materials", H5T_STD_U8LE, H5T_NATIVE_UINT8, {materials.size(), 2},
                materials.data());
}

// As in a robot's file, in JSON.
void TrajectoryWriter::write_brains(hid_t particles, const Robot& robot) {
  if (!robot.sensors.empty()) write_text_dataset(particles, "sensors", sensors_as_json(robot));
  if (robot.brain) write_text_dataset(particles, "brain", brain_as_json(*robot.brain));
}

// Beside the values: what each column is.
void TrajectoryWriter::write_brain_names(std::size_t index, const Robot& robot) {
  if (senses_.width(index) == 0 && neurons_.width(index) == 0) return;
  if (hid_t{observables_} < 0) observables_ = create_ordered_group(file_, "observables");
  const Handle group = create_group(observables_, groups_[index]);
  const BrainLayout layout = brain_layout(robot);
  if (!layout.senses.empty()) write_text_dataset(create_group(group, "senses"), "name", layout.senses);
  if (!layout.neurons.empty()) write_text_dataset(create_group(group, "neurons"), "name", layout.neurons);
}

std::size_t TrajectoryWriter::frame_bytes() const {
  return positions_.bytes() + velocities_.bytes() + senses_.bytes() + neurons_.bytes();
}

void TrajectoryWriter::hold(std::size_t frames_per_block) {
  frames_per_block_ = frames_per_block;
  positions_.hold(frames_per_block);
  velocities_.hold(frames_per_block);
  senses_.hold(frames_per_block);
  neurons_.hold(frames_per_block);
}

// With the first block. From here on, the file can be read at every moment.
void TrajectoryWriter::start_frames() {
  const auto count = static_cast<std::size_t>(frames_);
  if (count > 0 && count < frames_per_block_) hold(count);
  for (std::size_t robot = 0; robot < groups_.size(); ++robot) {
    const auto create = [&](const auto& series, hid_t parent) {
      if (series.width(robot) > 0)
        series.create(robot, open_group(parent, groups_[robot]), parameters_, frames_per_block_, deflate_);
    };
    create(positions_, particles_);
    create(velocities_, particles_);
    create(senses_, observables_);
    create(neurons_, observables_);
  }
  if (survives_kill()) checked(H5Fstart_swmr_write(file_));
  started_ = true;
}

TrajectoryWriter::Frame TrajectoryWriter::add(std::int64_t step, double time) {
  const auto index = static_cast<std::size_t>(frames_ - written_);
  next_step_ = step;
  next_time_ = time;
  return {positions_.frame(index), velocities_.frame(index), senses_.frame(index), neurons_.frame(index)};
}

void TrajectoryWriter::commit() {
  steps_.push_back(next_step_);
  times_.push_back(next_time_);
  ++frames_;
  const double now = clock_(), before = std::exchange(last_commit_, now);
  if (flush_is_due(now - last_flush_, now - before, flush_period_)) return flush();
  if (frames_ - written_ < static_cast<std::int64_t>(frames_per_block_)) return;
  // A full block costs no second writing, and what is flushed is kept if the disk is full soon.
  constexpr double most_share = 0.05;  // of the time, for these flushes
  if (survives_kill() && most_share * (now - last_flush_) >= flush_cost_) return flush();
  guarded([&] { write_block(); });
}

// HDF5 cannot complete a file on a full disk. So that it never meets one, there must be room for the block, and for all
// that follows if it is the last, before anything of it is written.
void TrajectoryWriter::reserve_block() {
  constexpr hsize_t metadata = 1 << 20;
  const hsize_t metadata_per_robot = senses_.width() + neurons_.width() > 0 ? 8 << 10 : 4 << 10;  // with room to spare
  const hsize_t block = frames_per_block_ * frame_bytes();
  const hsize_t blocks = deflate_ > 0 ? 2 : 1;  // a compressed one that was flushed early is written again elsewhere
  hsize_t size = 0;
  checked(H5Fget_filesize(file_, &size));
  const hsize_t end = size + blocks * block + metadata + metadata_per_robot * groups_.size();
  try {
    if (end > reserved_) reserve(file_, reserved_, end);
    reserved_ = std::max<std::uint64_t>(reserved_, end);
  } catch (const Error&) {
    if (reserved_ > 0) throw;  // before the first block, all may fit all the same
  }
}

// Appends the frames in memory, not yet their steps and times.
void TrajectoryWriter::write_block() {
  if (!survives_kill() && (!started_ || frames_ > written_)) reserve_block();
  if (!started_) start_frames();
  if (frames_ == written_) return;
  const auto first = static_cast<std::size_t>(written_), count = static_cast<std::size_t>(frames_ - written_);
  for (std::size_t robot = 0; robot < groups_.size(); ++robot) {
    const auto write = [&](const auto& series, hid_t parent) {
      if (series.width(robot) == 0) return;
      series.write(robot, Handle(H5Gopen2(parent, groups_[robot].c_str(), H5P_DEFAULT)), first, count);
    };
    write(positions_, particles_);
    write(velocities_, particles_);
    write(senses_, observables_);
    write(neurons_, observables_);
  }
  written_ = frames_;
}

bool TrajectoryWriter::survives_kill() const { return groups_.size() <= most_robots_flushed; }

void TrajectoryWriter::flush() {
  if (started_ && flushed_ == frames_) return;
  double begin = 0;
  guarded([&] {
    write_block();
    begin = clock_();
    if (survives_kill()) checked(H5Fflush(file_, H5F_SCOPE_LOCAL));
    announce(frames_);
    if (survives_kill()) checked(H5Fflush(file_, H5F_SCOPE_LOCAL));
  });
  flushed_ = frames_;
  last_flush_ = clock_();
  flush_cost_ = last_flush_ - begin;
  steps_.clear();
  times_.clear();
}

// Writes the steps and times of the frames up to `count`.
void TrajectoryWriter::announce(std::int64_t count) {
  const auto first = static_cast<hsize_t>(flushed_), added = static_cast<hsize_t>(count - flushed_);
  append_rows(open_dataset(parameters_, "step"), H5T_NATIVE_INT64, first, added, steps_.data());
  append_rows(open_dataset(parameters_, "time"), H5T_NATIVE_DOUBLE, first, added, times_.data());
}

// Closes the file, as long as its content.
void TrajectoryWriter::close() {
  for (Handle* group : {&particles_, &connectivity_, &parameters_, &observables_})
    if (hid_t{*group} >= 0) group->close();
  checked(H5Fflush(file_, H5F_SCOPE_LOCAL));
  file_.close();
  std::error_code ignored;
  if (reserved_ > 0)  // gives back the rest
    std::filesystem::resize_file(unfinished_.path(), std::filesystem::file_size(unfinished_.path(), ignored), ignored);
}

void TrajectoryWriter::finish(std::span<const Telemetry> telemetry) {
  flush();
  guarded([&] {
    for (std::size_t robot = 0; robot < telemetry.size(); ++robot) {
      if (!telemetry[robot].exploded) continue;
      const Handle group = open_group(particles_, groups_[robot]);
      write_attribute(group, "exploded_at", telemetry[robot].exploded_at);
      if (telemetry[robot].culprit_spring != no_spring)
        write_attribute(group, "first_bad_spring", telemetry[robot].culprit_spring);
    }
    close();
  });
  unfinished_.keep();
}

}  // namespace mercury
