// SPDX-License-Identifier: Apache-2.0
// export(): robots and recordings as files of other programs.
#include "app/export/export.h"

#include <nanobind/stl/string.h>

#include <optional>
#include <string>
#include <utility>

#include "mercury/error.h"
#include "python/src/bindings.h"
#include "python/src/gil.h"
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

void export_robot(const Robot& robot, const Request& request) {
  if (request.still || request.range.from || request.range.to || request.range.every != 1 || !request.robot.is_none())
    throw ParameterError("robot, still, start, end, every", "choose from a Recording; a robot is exported at rest");
  const ExportFormat& format = format_for(request.path, request.format);
  require_pose(format, robot, request.springs);
  const ReleasedGil released;
  request.prepare(format);
  format.pose(exported_robot(robot), rest_pose(robot), request.path, {.springs = request.springs});
}

std::size_t robot_of(const TrajectoryReader& recording, nb::handle robot) {
  const std::string name = robot.is_none()                  ? ""
                           : nb::isinstance<nb::str>(robot) ? text_from("robot", robot)
                                                            : std::to_string(whole_from("robot", robot, 0));
  const std::vector<std::size_t> chosen = chosen_robots(name, names_of_robots(recording));
  if (chosen.size() > 1)
    throw ParameterError("robot", "the recording has " + std::to_string(chosen.size()) + "; give a name or an index");
  return chosen.front();
}

// Ctrl-C.
void check_signals(std::optional<nb::python_error>& stopped) {
  const nb::gil_scoped_acquire acquired;
  if (PyErr_CheckSignals() != 0) stopped.emplace();
}

// Reads the file again: the Recording may be in use by another thread.
void export_recording(const TrajectoryReader& given, const Request& request) {
  struct Interrupted {};
  if (request.still && (request.range.from || request.range.to || request.range.every != 1))
    throw ParameterError("still", "not together with start, end and every, which choose a motion");
  const ExportFormat& format = format_for(request.path, request.format);
  const std::size_t robot = robot_of(given, request.robot);
  std::optional<nb::python_error> stopped;
  try {
    const ReleasedGil released;
    const auto recording = std::make_shared<TrajectoryReader>(given.path());
    RecordedMotion motion = request.still ? RecordedMotion::still(recording, robot, *request.still)
                                          : RecordedMotion(recording, robot, request.range);
    const Robot& body = motion.robot().robot;
    request.still ? require_pose(format, body, request.springs) : require_motion(format, body, request.springs);
    request.prepare(format);
    const ExportChoices choices{.springs = request.springs, .watch = [&](std::size_t, std::size_t) {
                                  check_signals(stopped);
                                  if (stopped) throw Interrupted();
                                }};
    if (request.still)
      format.pose(motion.robot(), motion.pose_with_velocities(0), request.path, choices);
    else
      format.motion(motion.robot(), motion, request.path, choices);
  } catch (const Interrupted&) {
    throw nb::python_error(std::move(*stopped));
  }
}

void export_any(nb::handle what, nb::handle path, nb::handle format, nb::handle robot, nb::handle still,
                nb::handle start, nb::handle end, nb::handle every, nb::handle springs) {
  const Request request{.path = path_from("path", path),
                        .format = format.is_none() ? "" : text_from("format", format),
                        .robot = nb::borrow(robot),
                        .still = number_or_none("still", still),
                        .range = {.from = number_or_none("start", start),
                                  .to = number_or_none("end", end),
                                  .every = whole_from("every", every, 1)},
                        .springs = bool_from("springs", springs)};
  SharedRobot shared;
  try {
    if (nb::try_cast(what, shared)) return export_robot(*shared.robot, request);
    if (nb::isinstance<TrajectoryReader>(what))
      return export_recording(nb::cast<const TrajectoryReader&>(what), request);
  } catch (const ParameterError& error) {
    rethrow_as_argument(error);
  }
  refuse_type("what", "a Robot or a Recording", what);
}

}  // namespace

void bind_export(nb::module_& module) {
  std::string doc =
      "Writes a Robot at rest, or the motion of a robot of a Recording, as files of another program. The extension of "
      "`path` says the format, or `format`:\n\n";
  for (const ExportFormat& format : export_formats())
    doc += "- " + std::string(format.name) + ": " + std::string(format.help) + "\n";
  doc +=
      "\nOf a recording, `robot` is a name or an index (not needed if there is one), `start`, `end` [s from the first "
      "frame] and `every` choose frames, and `still` [s] is the moment of a pose. `springs` writes the springs as "
      "lines, "
      "too. Files are replaced, whole or not at all. Raises InputError for what the format cannot hold.";
  module.def("export", &export_any, nb::arg("what").none(), nb::arg("path").none(),
             nb::arg("format").none() = nb::none(), nb::kw_only(), nb::arg("robot").none() = nb::none(),
             nb::arg("still").none() = nb::none(), nb::arg("start").none() = nb::none(),
             nb::arg("end").none() = nb::none(), nb::arg("every").none() = 1, nb::arg("springs").none() = false,
             nb::sig("def export(what: Robot | Recording, path: str | os.PathLike[str], format: str | None = None, *, "
                     "robot: str | int | None = None, still: float | None = None, start: float | None = None, "
                     "end: float | None = None, every: int = 1, springs: bool = False) -> None"),
             doc.c_str());
}

}  // namespace mercury::python
