// SPDX-License-Identifier: Apache-2.0
// Robot: a robot as plain data.
#include "mercury/robot.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include "mercury/robot_file.h"
#include "python/src/bindings.h"

namespace mercury::python {
namespace {

nb::object wrap(Robot robot) { return nb::cast(SharedRobot{std::make_shared<const Robot>(std::move(robot))}); }

nb::object load(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return wrap(load_robot(path));
  nb::list robots;
  for (Robot& robot : load_robots(std::span(&path, 1))) robots.append(wrap(std::move(robot)));
  return robots;
}

}  // namespace

SharedRobots robots_of(nb::handle robots) {
  if (SharedRobot one; nb::try_cast(robots, one)) return {one.robot};
  SharedRobots all;
  for (const nb::handle robot : robots) all.push_back(nb::cast<SharedRobot>(robot).robot);
  return all;
}

void bind_robot(nb::module_& module) {
  nb::class_<SharedRobot>(module, "Robot", "A robot as plain data: masses of 1 kg, springs that join them, and a skin.")
      .def_prop_ro("name", [](const SharedRobot& self) { return self.robot->name; })
      .def_prop_ro(
          "masses",
          [](nb::handle_t<SharedRobot> self) {
            const Robot& robot = *nb::cast<const SharedRobot&>(self).robot;
            return nb::ndarray<nb::numpy, const float, nb::ndim<2>>(reinterpret_cast<const float*>(robot.masses.data()),
                                                                    {robot.masses.size(), 3}, self);
          },
          "Positions at rest, (masses, 3) [m]. Shares memory with the robot.")
      .def("save", [](const SharedRobot& self, const std::filesystem::path& path) { save_robot(path, *self.robot); });
  module.def("load", &load, nb::arg("path"), "The robot of a file, or a list of the robots of a folder.");
}

}  // namespace mercury::python
