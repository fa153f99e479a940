// SPDX-License-Identifier: Apache-2.0
#include "app/export/export.h"

#include <fmt/format.h>

#include <variant>

#include "mercury/error.h"
#include "mercury/number_text.h"

namespace mercury {
namespace {

void require_content(const ExportFormat& format, const Robot& robot, bool springs) {
  if (springs && format.springs == ExportFormat::Springs::never)
    throw ParameterError(
        "springs", fmt::format("a {} file holds no springs; give {}", format.extension, format_names(holds_springs)));
  if (format.needs_skin && robot.faces.empty() && !springs)
    throw InputError(robot.name, fmt::format("has no skin, which a {} file holds; give vtu, or springs with {}",
                                             format.extension, format_names([](const ExportFormat& other) {
                                               return other.springs == ExportFormat::Springs::if_asked;
                                             })));
}

}  // namespace

const ExportFormat& format_for(const std::filesystem::path& file, const std::string& name) {
  const ExportFormat* by_extension = export_format_of(file);
  if (name.empty()) {
    if (by_extension) return *by_extension;
    throw ParameterError("format", fmt::format("{} does not say it; give {}", file.string(), format_names()));
  }
  const ExportFormat& format = export_format(name);
  if (by_extension && by_extension != &format)
    throw ParameterError("output", fmt::format("{} is a name of {} files; give one that ends in {}", file.string(),
                                               by_extension->name, format.extension));
  return format;
}

void require_pose(const ExportFormat& format, const Robot& robot, bool springs) {
  if (!holds_pose(format))
    throw ParameterError("format",
                         fmt::format("{} holds a motion, which comes from a recording: mercury run ROBOT --seconds 5 "
                                     "--record run.h5; for one pose give {}",
                                     format.name, format_names(holds_pose)));
  require_content(format, robot, springs);
}

void require_motion(const ExportFormat& format, const Robot& robot, bool springs) {
  if (!holds_motion(format))
    throw ParameterError(
        "format", fmt::format("{} holds one pose of a recording; choose its moment (still), or give {}", format.name,
                              format_names(holds_motion)));
  require_content(format, robot, springs);
}

void require_stage(const ExportFormat& format, const StageChoices& stage) {
  if (format.holds_scene || (!stage.floor && !stage.camera)) return;
  throw ParameterError(stage.floor ? "floor" : "with_camera",
                       fmt::format("a {} file is no scene; give {}", format.extension, format_names(holds_scene)));
}

std::vector<std::string> names_of_robots(const TrajectoryReader& recording) {
  std::vector<std::string> names;
  for (const RecordedRobot& recorded : recording.robots()) names.push_back(recorded.robot.name);
  return names;
}

std::vector<std::size_t> chosen_robots(const std::string& robot, const std::vector<std::string>& names) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (robot.empty() || names[i] == robot) chosen.push_back(i);
  for (std::size_t i = 0; chosen.empty() && i < names.size(); ++i)
    if (std::to_string(i) == robot) chosen.push_back(i);
  if (chosen.empty())
    throw ParameterError("robot", fmt::format("no robot is named \"{}\"; give a name, or a number from 0 to {}", robot,
                                              names.size() - 1));
  if (!robot.empty() && chosen.size() > 1)
    throw ParameterError("robot", fmt::format("{} robots are named \"{}\"; give a number from 0 to {}", chosen.size(),
                                              robot, names.size() - 1));
  return chosen;
}

void add_outputs(const ExportFormat& format, const std::filesystem::path& file, OutputFiles& outputs,
                 const std::string& option, const std::filesystem::path& inside) {
  outputs.add_file(option, file.string(), inside);
  const std::filesystem::path beside = file.has_parent_path() ? file.parent_path() : ".";
  if (format.files_beside)
    for (const std::filesystem::path& other : format.files_beside(file))
      outputs.add_file(option, other.string(), beside);
  if (format.folder_beside) outputs.add_new_folder(option, format.folder_beside(file).string(), beside);
}

std::string outputs_text(const ExportFormat& format, const std::filesystem::path& file) {
  std::string text = file.string();
  if (format.files_beside)
    for (const std::filesystem::path& other : format.files_beside(file)) text += fmt::format(", {}", other.string());
  if (format.folder_beside) text += fmt::format(", the folder {}", format.folder_beside(file).string());
  return text;
}

namespace {

std::vector<std::string> lost_of(const Environment& environment) {
  std::vector<std::string> lost;
  const auto lose = [&](bool is_lost, const char* what) {
    if (is_lost) lost.emplace_back(what);
  };
  const bool fluid = has_face_forces(environment);
  lose(environment.gravity.x != 0 || environment.gravity.y != 0, "gravity has no parts along x and y there");
  lose(fluid && environment.gravity.z != 0, "there is no gravity in water there");
  lose(fluid && has_ground(environment), "there is no floor under water there");
  lose(std::holds_alternative<FaceDrag>(environment.water),
       "water there has a normal drag alone, as resistive water has; it gets the drag coefficient");
  if (const auto* water = std::get_if<ResistiveDrag>(&environment.water)) {
    lose(water->tangential_coefficient != 0 || water->added_mass_coefficient != 0,
         "water there has no tangential drag, added mass and buoyancy");
    lose(!water->one_sided, "water there is one-sided; it slows a rigid body as much");
  }
  if (const auto* water = std::get_if<PointDrag>(&environment.water))
    lose(water->point_drag != 0, "water there acts on faces alone; the drag of masses is left out");
  const Vec3 flow = flow_of(environment);
  lose(flow.x != 0 || flow.y != 0 || flow.z != 0, "water there does not flow");
  return lost;
}

}  // namespace

VxaWorld vxa_world(const Environment& environment, double damping, std::optional<double> seconds) {
  VxaWorld world{.settings = {.environment = has_face_forces(environment) ? "resistive"
                                             : has_ground(environment)    ? "land"
                                                                          : "ocean-simple",
                              .gravity = shortest(environment.gravity.z),
                              .stiffness_scale = shortest(environment.stiffness_scale),
                              .self_collision = has_contacts(environment),
                              .damping = damping,
                              .seconds = seconds},
                 .lost = lost_of(environment)};
  if (const auto* plane = std::get_if<Plane>(&environment.ground)) {
    world.settings.friction = shortest(plane->friction);
    world.settings.static_friction = shortest(plane->static_friction);
  }
  // One-sided water slows a rigid body by its windward faces alone.
  const auto coefficient = [](float own, float density) { return shortest(own) * shortest(density) / 1000; };
  if (const auto* water = std::get_if<ResistiveDrag>(&environment.water))
    world.settings.drag_coefficient =
        (water->one_sided ? 1 : 2) * coefficient(water->normal_coefficient, water->density);
  if (const auto* water = std::get_if<FaceDrag>(&environment.water))
    world.settings.drag_coefficient = 2 * coefficient(water->drag_coefficient, water->density);
  return world;
}

}  // namespace mercury
