// SPDX-License-Identifier: Apache-2.0
// Recording: what `mercury run --record` wrote, frame by frame.
#include "app/recording/trajectory_reader.h"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app/base/output_files.h"
#include "app/recording/recorder.h"
#include "mercury/error.h"
#include "python/src/array.h"
#include "python/src/batch.h"
#include "python/src/bindings.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

constexpr const char* description =
    "What `mercury run --record FILE.h5` wrote: robots, and the positions and velocities of their masses.\n\n"
    "    recording = mercurysim.Recording(\"run.h5\")\n"
    "    start, end = recording.positions(0), recording.positions(-1)\n"
    "    first = end[recording.offsets[0] : recording.offsets[1]]  # of the first robot\n\n"
    "len() is the number of frames. senses() and neurons() are those of robots with brains, if they were recorded. "
    "Raises InputError if the file is not a recording or is damaged.";

// An array of its own, since the reader uses its memory again.
nb::object masses_of(std::span<const Vec3> masses) {
  std::vector<float> values;
  values.reserve(3 * masses.size());
  for (const Vec3 mass : masses) values.insert(values.end(), {mass.x, mass.y, mass.z});
  return owned_array(std::move(values), {masses.size(), 3});
}

// Frames count from the end if negative, as in Python. Throws IndexError.
std::size_t frame_of(const TrajectoryReader& recording, nb::handle frame) {
  const std::int64_t given = whole_from("frame", frame), frames = static_cast<std::int64_t>(recording.frames());
  const std::int64_t index = given < 0 ? given + frames : given;
  if (index < 0 || index >= frames)
    throw std::out_of_range("frame " + std::to_string(given) + " is out of range, the recording has " +
                            std::to_string(frames));
  return static_cast<std::size_t>(index);
}

nb::list robots(const TrajectoryReader& recording) {
  nb::list robots;
  for (const RecordedRobot& recorded : recording.robots())
    robots.append(SharedRobot{std::make_shared<const Robot>(recorded.robot)});
  return robots;
}

template <class T, class Of>
nb::object per_frame(const TrajectoryReader& recording, Of of) {
  std::vector<T> values;
  for (std::size_t frame = 0; frame < recording.frames(); ++frame) values.push_back((recording.*of)(frame));
  const std::size_t count = values.size();
  return owned_array(std::move(values), {count});
}

std::size_t robot_of(const TrajectoryReader& recording, nb::handle robot) {
  const std::int64_t index = whole_from("robot", robot);
  if (index < 0 || index >= static_cast<std::int64_t>(recording.robots().size()))
    throw std::out_of_range("robot " + std::to_string(index) + " is out of range, the recording has " +
                            std::to_string(recording.robots().size()));
  return static_cast<std::size_t>(index);
}

// A row per frame.
using SeriesOfRobot = std::span<const float> (TrajectoryReader::*)(std::size_t, std::size_t);
nb::object brain_series(TrajectoryReader& recording, nb::handle robot, SeriesOfRobot series) {
  if (!recording.has_brains())
    throw InputError(recording.path().string(),
                     "has no senses and neurons; Recorder(brains=True) and mercury run --brains record them");
  const std::size_t index = robot_of(recording, robot);
  std::vector<float> values;
  std::size_t width = 0;
  for (std::size_t frame = 0; frame < recording.frames(); ++frame) {
    const std::span<const float> row = (recording.*series)(index, frame);
    width = row.size();
    values.insert(values.end(), row.begin(), row.end());
  }
  return owned_array(std::move(values), {recording.frames(), width});
}

nb::object brain_frame(TrajectoryReader& recording, nb::handle robot) {
  const nb::module_ pandas = nb::module_::import_("pandas");
  const BrainLayout layout = brain_layout(recording.robots()[robot_of(recording, robot)].robot);
  const nb::object index =
      pandas.attr("Index")(per_frame<double>(recording, &TrajectoryReader::time), nb::arg("name") = "time");
  nb::dict parts;
  const auto add = [&](const char* name, const std::vector<std::string>& names, SeriesOfRobot series) {
    nb::list columns;
    for (const std::string& column : names) columns.append(column);
    parts[name] = pandas.attr("DataFrame")(brain_series(recording, robot, series), nb::arg("index") = index,
                                           nb::arg("columns") = columns);
  };
  add("senses", layout.senses, &TrajectoryReader::senses_of);
  add("neurons", layout.neurons, &TrajectoryReader::neurons_of);
  return pandas.attr("concat")(parts, nb::arg("axis") = 1);
}

// Records a batch that Python steps.
class BatchRecorder {
 public:
  BatchRecorder(nb::object batch, const std::filesystem::path& path, std::optional<std::int64_t> every,
                std::optional<double> fps, bool brains)
      : batch_(std::move(batch)), every_(every) {
    if (every.has_value() == fps.has_value())
      throw ParameterError("every, fps", "give one of them: steps per frame, or frames per second");
    OutputFiles outputs(true, false);
    outputs.add_file("path", path.string());
    outputs.check();
    outputs.make_folders();
    of_batch().use([&](const Simulation& simulation) {
      robots_ = simulation.size();
      if (fps) require_frame_rate("fps", *fps, simulation.configuration().dt);
      recorder_.emplace(simulation, path, RecordingOptions{.every = every.value_or(1), .rate = fps, .brains = brains});
    });
  }

  void frame() {
    require_open();
    if (!every_) throw InputError("with fps, frames may lie between steps; step the batch by step() of the recorder");
    of_batch().use([&](const Simulation& simulation) {
      require_same_robots(simulation);
      const std::int64_t next = recorder_->next_step();
      if (simulation.steps() != next)
        throw InputError("a frame is due at step " + std::to_string(next) + " and the batch is at step " +
                         std::to_string(simulation.steps()) + "; step it " + std::to_string(*every_) +
                         " steps per frame (every)");
      recorder_->observe();
    });
  }

  // Takes the frames on the way.
  void step(std::int64_t steps) {
    require_open();
    Batch& batch = nb::cast<Batch&>(batch_);
    do {
      const std::int64_t wait = batch.use([&](const Simulation& simulation) {
        require_same_robots(simulation);
        return recorder_->next_step() - simulation.steps();
      });
      if (wait < 0)
        throw InputError("a frame was due " + std::to_string(-wait) + " steps ago; step by the recorder alone");
      const std::int64_t count = std::min(steps, wait);
      batch.step(count, nb::none());
      batch.use([&](const Simulation&) { recorder_->observe(); });
      steps -= count;
    } while (steps > 0);
  }

  void close() {
    if (!recorder_) return;
    of_batch().use([&](const Simulation&) { recorder_->finish(); });
    recorder_.reset();
  }

  std::int64_t frames() const { return recorder_ ? recorder_->frames() : 0; }

 private:
  const Batch& of_batch() const { return nb::cast<const Batch&>(batch_); }
  void require_same_robots(const Simulation& simulation) const {
    if (simulation.size() != robots_) throw InputError("robots came or went; a recording has the same all the time");
  }
  void require_open() const {
    if (!recorder_) throw InputError("the recording is closed");
  }

  nb::object batch_;
  std::optional<std::int64_t> every_;
  std::size_t robots_ = 0;
  std::optional<Recorder> recorder_;
};

constexpr const char* recorder_description =
    "Records a batch that you step yourself, as `mercury run --record` does.\n\n"
    "    with mercurysim.Recorder(batch, \"episode.h5\", fps=30) as recorder:\n"
    "        for _ in range(100):\n"
    "            recorder.step(20)\n"
    "    mercurysim.show(mercurysim.Recording(\"episode.h5\"))\n\n"
    "Give `every` (steps per frame) or `fps` (frames per second, exactly; interpolated where they fall between two "
    "steps). The first frame is the batch as it is when the recording begins. step() steps the batch and takes all "
    "frames on the way; with `every`, a program may also step the batch itself and call frame() at each frame's step. "
    "With `brains`, frames also have the senses and neurons of robots with brains. "
    "The file is there once the recorder is closed, and replaces one of that name. Raises InputError for frames at "
    "other steps, and after robots came or went.";

void bind_recorder(nb::module_& module) {
  nb::class_<BatchRecorder>(module, "Recorder", recorder_description)
      .def(
          "__init__",
          [](BatchRecorder* self, nb::handle_t<Batch> batch, nb::handle path, nb::handle every, nb::handle fps,
             bool brains) {
            std::optional<std::int64_t> steps;
            std::optional<double> rate;
            if (!every.is_none()) steps = whole_from("every", every, 1);
            if (!fps.is_none()) rate = number_from("fps", fps);
            new (self) BatchRecorder(nb::borrow(batch), path_from("path", path), steps, rate, brains);
          },
          nb::arg("batch"), nb::arg("path"), nb::arg("every") = nb::none(), nb::arg("fps") = nb::none(),
          nb::arg("brains") = false,
          nb::sig("def __init__(self, batch: Batch, path: str | os.PathLike[str], every: int | None = None, "
                  "fps: float | None = None, brains: bool = False) -> None"))
      .def(
          "step", [](BatchRecorder& self, nb::handle n) { self.step(whole_from("n", n, 0)); }, nb::arg("n") = 1,
          nb::sig("def step(self, n: int = 1) -> None"),
          "Advances the batch by `n` time steps and takes the frames on the way.")
      .def("frame", &BatchRecorder::frame, "Adds the batch as it is now; with `every` alone.")
      .def("close", &BatchRecorder::close, "Completes the file.")
      .def_prop_ro("frames", &BatchRecorder::frames, "Number of frames so far.")
      .def(
          "__enter__", [](nb::handle_t<BatchRecorder> self) { return nb::borrow(self); },
          nb::sig("def __enter__(self) -> Recorder"))
      .def(
          "__exit__", [](BatchRecorder& self, const nb::args&) { self.close(); }, nb::arg("error"),
          nb::sig("def __exit__(self, *error: object) -> None"));
}

}  // namespace

void bind_recording(nb::module_& module) {
  bind_recorder(module);
  nb::class_<TrajectoryReader>(module, "Recording", description)
      .def(
          "__init__",
          [](TrajectoryReader* self, nb::handle path) { new (self) TrajectoryReader(path_from("path", path)); },
          nb::arg("path"), nb::sig("def __init__(self, path: str | os.PathLike[str]) -> None"))
      .def("__len__", &TrajectoryReader::frames)
      .def("__repr__",
           [](const TrajectoryReader& self) {
             return "<Recording of " + std::to_string(self.robots().size()) + " robots, " +
                    std::to_string(self.frames()) + " frames>";
           })
      .def_prop_ro("robots", &robots, nb::sig("def robots(self) -> list[Robot]"), "The robots, at rest.")
      .def_prop_ro(
          "times", [](const TrajectoryReader& self) { return per_frame<double>(self, &TrajectoryReader::time); },
          nb::sig("def times(self) -> numpy.typing.NDArray[numpy.float64]"), "The time of each frame, (frames,) [s].")
      .def_prop_ro(
          "steps", [](const TrajectoryReader& self) { return per_frame<std::int64_t>(self, &TrajectoryReader::step); },
          nb::sig("def steps(self) -> numpy.typing.NDArray[numpy.int64]"), "The time step of each frame, (frames,).")
      .def_prop_ro(
          "offsets",
          [](const TrajectoryReader& self) {
            const auto offsets = self.mass_offsets();
            return owned_array(std::vector<std::int64_t>(offsets.begin(), offsets.end()), {offsets.size()});
          },
          nb::sig("def offsets(self) -> numpy.typing.NDArray[numpy.int64]"),
          "Robot i has the masses offsets[i] to offsets[i + 1] of a frame; robots + 1 elements.")
      .def(
          "positions",
          [](TrajectoryReader& self, nb::handle frame) { return masses_of(self.positions(frame_of(self, frame))); },
          nb::arg("frame"), nb::sig("def positions(self, frame: int) -> numpy.typing.NDArray[numpy.float32]"),
          "Positions of all masses in a frame, (masses, 3) [m]; -1 = the last frame. Raises IndexError.")
      .def(
          "velocities",
          [](TrajectoryReader& self, nb::handle frame) { return masses_of(self.velocities(frame_of(self, frame))); },
          nb::arg("frame"), nb::sig("def velocities(self, frame: int) -> numpy.typing.NDArray[numpy.float32]"),
          "Velocities of all masses in a frame, (masses, 3) [m/s]; -1 = the last frame. Raises IndexError.")
      .def(
          "senses",
          [](TrajectoryReader& self, nb::handle robot) {
            return brain_series(self, robot, &TrajectoryReader::senses_of);
          },
          nb::arg("robot"), nb::sig("def senses(self, robot: int) -> numpy.typing.NDArray[numpy.float32]"),
          "What a robot's brain sampled last in each frame, (frames, senses), named in Robot.brain_layout; no columns "
          "without a brain. Raises InputError if the recording has none (brains=True, mercury run --brains).")
      .def(
          "neurons",
          [](TrajectoryReader& self, nb::handle robot) {
            return brain_series(self, robot, &TrajectoryReader::neurons_of);
          },
          nb::arg("robot"), nb::sig("def neurons(self, robot: int) -> numpy.typing.NDArray[numpy.float32]"),
          "Its neurons, (frames, neurons), as senses().")
      .def("brain_frame", &brain_frame, nb::arg("robot"), nb::sig("def brain_frame(self, robot: int) -> typing.Any"),
           "senses() and neurons() as a DataFrame of pandas, with the time as its index and columns such as "
           "(\"neurons\", "
           "\"motor 0\").")
      .def_prop_ro(
          "has_brains", [](const TrajectoryReader& self) { return self.has_brains(); },
          "Whether it has senses and neurons.")
      .def_prop_ro(
          "program", [](const TrajectoryReader& self) { return self.program(); }, "What wrote it: \"mercury 0.2.0\".")
      .def_prop_ro(
          "device_name", [](const TrajectoryReader& self) { return self.device_name(); }, "What stepped the robots.");
}

}  // namespace mercury::python
