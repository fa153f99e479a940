// SPDX-License-Identifier: Apache-2.0
// export(): robots and recordings as files of other programs.
#include "app/export/export.h"

#include <nanobind/stl/string.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/export/simulated_motion.h"
#include "mercury/error.h"
#include "python/src/batch.h"
#include "python/src/bindings.h"
#include "python/src/result.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

// None = absent.
std::optional<double> number_or_none(const char* name, nb::handle value) {
  return value.is_none() ? std::nullopt : std::optional(number_from(name, value));
}

// "from" is a word of Python's own.
[[noreturn]] void rethrow_as_argument(const ParameterError& error) {
  for (const auto& [parameter, argument] :
       {std::pair{"from", "start"}, std::pair{"to", "end"}, std::pair{"output", "path"}})
    if (error.parameter() == parameter) throw ParameterError(argument, error.problem());
  throw error;
}

struct Request {
  std::filesystem::path path;
  std::string format;
  nb::object robot;
  std::optional<double> still;
  FrameRange range;
  bool springs = false;
  StageChoices stage;
  std::optional<double> seconds;
  nb::object environment;

  // Files are replaced; a folder must be new or empty.
  void prepare(const ExportFormat& chosen) const {
    if (chosen.folder_beside) {
      std::error_code ignored;
      const std::filesystem::path folder = chosen.folder_beside(path);
      if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_empty(folder, ignored))
        throw ParameterError("path", folder.string() + " is not empty; remove it, or give another path");
    }
    OutputFiles outputs(true, false);
    add_outputs(chosen, path, outputs, "path");
    outputs.check();
    outputs.make_folders();
  }
};

constexpr double usual_seconds = 10;  // of robots that are simulated

void refuse_choices(const Request& request) {
  if (request.still || request.range.from || request.range.to || request.range.every != 1 || !request.robot.is_none())
    throw ParameterError("robot, still, start, end, every",
                         "choose from a Recording; a robot is exported at rest, or "
                         "its motion for `seconds`");
}

void export_pose(const Robot& robot, const ExportFormat& format, const Request& request) {
  require_pose(format, robot, request.springs);
  Environment environment;
  if (!request.environment.is_none()) environment = environment_of(request.environment);
  const ReleasedGil released;
  request.prepare(format);
  std::optional<ImportedSettings> world;
  if (format.holds_world && !request.environment.is_none()) world = vxa_world(environment, 0).settings;
  format.pose(exported_robot(robot), rest_pose(robot), request.path,
              {.springs = request.springs, .stage = request.stage, .world = world});
}

std::vector<std::size_t> recorded_robots(const TrajectoryReader& recording, nb::handle robot, bool several) {
  const std::string name = robot.is_none()                  ? ""
                           : nb::isinstance<nb::str>(robot) ? text_from("robot", robot)
                                                            : std::to_string(whole_from("robot", robot, 0));
  std::vector<std::size_t> chosen = chosen_robots(name, names_of_robots(recording));
  if (chosen.size() > 1 && !several)
    throw ParameterError("robot", "the recording has " + std::to_string(chosen.size()) + "; give a name or an index");
  return chosen;
}

// Work without the GIL that Ctrl-C ends between two frames.
class InterruptibleWork {
 public:
  // Call it after each frame.
  void check() {
    const nb::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() == 0) return;
    stopped_.emplace();
    throw Interrupted();
  }
  template <class Work>
  void run(const Work& work) {
    try {
      const ReleasedGil released;
      work();
    } catch (const Interrupted&) {
      throw nb::python_error(std::move(*stopped_));
    }
  }

 private:
  struct Interrupted {};
  std::optional<nb::python_error> stopped_;
};

void write_motions(std::vector<RecordedMotion>& motions, const ExportFormat& format, const Request& request,
                   InterruptibleWork& work, std::vector<std::string> final_states = {}) {
  const ExportChoices choices{.springs = request.springs,
                              .stage = request.stage,
                              .notes = {.final_states = std::move(final_states)},
                              .watch = [&](std::size_t, std::size_t) { work.check(); }};
  if (format.motions)
    format.motions(motions, request.path, choices);
  else
    format.motion(motions.front().robot(), motions.front(), request.path, choices);
}

// Reads the file again: the Recording may be in use by another thread.
void export_recording(const TrajectoryReader& given, const Request& request) {
  if (request.still && (request.range.from || request.range.to || request.range.every != 1))
    throw ParameterError("still", "not together with start, end and every, which choose a motion");
  if (request.seconds) throw ParameterError("seconds", "a Recording has its own length; give start and end");
  const ExportFormat& format = format_for(request.path, request.format);
  const std::vector<std::size_t> robots =
      recorded_robots(given, request.robot, format.motions != nullptr && !request.still);
  InterruptibleWork work;
  work.run([&] {
    const auto recording = std::make_shared<TrajectoryReader>(given.path());
    if (request.still) {
      RecordedMotion motion = RecordedMotion::still(recording, robots.front(), *request.still);
      require_pose(format, motion.robot().robot, request.springs);
      request.prepare(format);
      const Configuration& configuration = recording->configuration();
      std::optional<ImportedSettings> world;
      if (format.holds_world)
        world = vxa_world(configuration.environment, configuration.damping, recording->time(recording->frames() - 1))
                    .settings;
      return format.pose(motion.robot(), motion.pose_with_velocities(0), request.path,
                         {.springs = request.springs, .stage = request.stage, .world = world});
    }
    std::vector<RecordedMotion> motions;
    for (const std::size_t robot : robots) {
      motions.emplace_back(recording, robot, request.range);
      require_motion(format, motions.back().robot().robot, request.springs);
    }
    request.prepare(format);
    write_motions(motions, format, request, work);
  });
}

void export_simulated(Simulation& simulation, const ExportFormat& format, const Request& request, double seconds) {
  if (!(seconds > 0 && seconds / simulation.configuration().dt < 1e9))
    throw ParameterError("seconds", "give a number of seconds above 0");
  for (std::size_t i = 0; i < simulation.size(); ++i) require_motion(format, simulation.robot(i), request.springs);
  if (simulation.size() != 1 && !format.motions)
    throw ParameterError("what", "has " + std::to_string(simulation.size()) + " robots, and a " +
                                     std::string(format.name) + " file holds one; give one of them");
  InterruptibleWork work;
  work.run([&] {
    request.prepare(format);
    const TemporaryRecording recording(request.path);
    SimulatedMotion motion =
        record_motion(simulation, seconds, recording.path(), std::nullopt, [&](std::int64_t) { work.check(); });
    const auto reader = std::make_shared<TrajectoryReader>(recording.path());
    std::vector<RecordedMotion> motions;
    for (std::size_t i = 0; i < simulation.size(); ++i) motions.emplace_back(reader, i);
    write_motions(motions, format, request, work, std::move(motion.final_states));
  });
}

// Goes on from where the batch is, which stays there.
void export_batch(const Batch& batch, const Request& request) {
  refuse_choices(request);
  if (!request.environment.is_none()) throw ParameterError("environment", "a batch has one already");
  const ExportFormat& format = format_for(request.path, request.format);
  const SharedRobots robots = batch.robots();
  if (robots.empty()) throw InputError("there is no robot to export");
  std::optional<Simulation> copy;
  batch.use([&](const Simulation& simulation) {
    copy.emplace(simulation.configuration(), robots);
    copy->restore(simulation.save());
  });
  export_simulated(*copy, format, request, request.seconds.value_or(usual_seconds));
}

void export_robots(const SharedRobots& robots, const Request& request) {
  refuse_choices(request);
  const ExportFormat& format = format_for(request.path, request.format);
  if (robots.empty()) throw InputError("there is no robot to export");
  if (!request.seconds && (holds_pose(format) || !holds_simulated_motion(format))) {
    if (robots.size() > 1) throw ParameterError("what", "one Robot is expected for a pose");
    return export_pose(*robots.front(), format, request);
  }
  // Where the first robot is made for.
  const Environment environment =
      request.environment.is_none() ? exported_robot(*robots.front()).environment : environment_of(request.environment);
  Simulation simulation(Configuration{.environment = environment}, robots);
  export_simulated(simulation, format, request, request.seconds.value_or(usual_seconds));
}

void export_results(const std::vector<const Result*>& results, const Request& request) {
  refuse_choices(request);
  if (request.seconds || !request.environment.is_none())
    throw ParameterError(request.seconds ? "seconds" : "environment", "a Result has its own");
  const ExportFormat& format = format_for(request.path, request.format);
  Repetition again = repetition_of(results);
  export_simulated(again.simulation, format, request, again.seconds);
}

void export_any(nb::handle what, nb::handle path, nb::handle format, nb::handle robot, nb::handle still,
                nb::handle start, nb::handle end, nb::handle every, nb::handle springs, nb::handle seconds,
                nb::handle environment, nb::handle floor, nb::handle camera) {
  const Request request{.path = path_from("path", path),
                        .format = format.is_none() ? "" : text_from("format", format),
                        .robot = nb::borrow(robot),
                        .still = number_or_none("still", still),
                        .range = {.from = number_or_none("start", start),
                                  .to = number_or_none("end", end),
                                  .every = whole_from("every", every, 1)},
                        .springs = bool_from("springs", springs),
                        .stage = {.floor = bool_from("floor", floor), .camera = bool_from("camera", camera)},
                        .seconds = number_or_none("seconds", seconds),
                        .environment = nb::borrow(environment)};
  try {
    require_stage(format_for(request.path, request.format), request.stage);
    if (nb::isinstance<TrajectoryReader>(what))
      return export_recording(nb::cast<const TrajectoryReader&>(what), request);
    if (const auto results = results_of(what); !results.empty()) return export_results(results, request);
    if (nb::isinstance<Batch>(what)) return export_batch(nb::cast<const Batch&>(what), request);
    SharedRobot shared;
    const bool is_robot = nb::try_cast(what, shared);
    if (!is_robot && (!PySequence_Check(what.ptr()) || nb::isinstance<nb::str>(what)))
      refuse_type("what", "a Robot, a Batch, a Recording, a Result of evaluate(), or a sequence of Robots or Results",
                  what);
    return export_robots(python::robots_of(what), request);
  } catch (const ParameterError& error) {
    rethrow_as_argument(error);
  }
}

}  // namespace

void bind_export(nb::module_& module) {
  std::string doc =
      "Writes a Robot at rest, or a motion, as files of another program: the motion of a robot of a Recording, or of "
      "robots that are simulated for `seconds`. The extension of `path` says the format, or `format`:\n\n";
  for (const ExportFormat& format : export_formats())
    doc += "- " + std::string(format.name) + ": " + std::string(format.help) + "\n";
  doc +=
      "\nOf a recording, `robot` is a name or an index (not needed if there is one), `start`, `end` [s from the first "
      "frame] and `every` choose frames, and `still` [s] is the moment of a pose. `springs` writes the springs as "
      "lines, "
      "too. Without `seconds`, robots are simulated for 10 s where the format holds motions alone, in `environment` or "
      "that which they are made for. A Batch goes on from where it is, and stays there. A Result of evaluate() is "
      "tried again, as it was. `floor` and `camera` add these to scenes (glb, usda, usdz), a camera that sees all of "
      "the "
      "motion. A vxa file has the world of a recording, or `environment`. A web page (html) holds "
      "several "
      "robots, also all of a recording, a batch or a sequence. Files are replaced, whole or not at all. Raises "
      "InputError for what the format cannot hold.";
  module.def(
      "export", &export_any, nb::arg("what").none(), nb::arg("path").none(), nb::arg("format").none() = nb::none(),
      nb::kw_only(), nb::arg("robot").none() = nb::none(), nb::arg("still").none() = nb::none(),
      nb::arg("start").none() = nb::none(), nb::arg("end").none() = nb::none(), nb::arg("every").none() = 1,
      nb::arg("springs").none() = false, nb::arg("seconds").none() = nb::none(),
      nb::arg("environment").none() = nb::none(), nb::arg("floor").none() = false, nb::arg("camera").none() = false,
      nb::sig("def export(what: Robot | Batch | Recording | Result | collections.abc.Sequence[Robot] | "
              "collections.abc.Sequence[Result], path: str | "
              "os.PathLike[str], format: str | None = None, *, "
              "robot: str | int | None = None, still: float | None = None, start: float | None = None, "
              "end: float | None = None, every: int = 1, springs: bool = False, seconds: float | None = None, "
              "environment: Environment | str | None = None, floor: bool = False, camera: bool = False) -> None"),
      doc.c_str());
}

}  // namespace mercury::python
