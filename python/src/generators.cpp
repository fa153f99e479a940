// SPDX-License-Identifier: Apache-2.0
// random_voxel() and its siblings, from the registry of generators.
#include "mercury/generator.h"

#include <algorithm>

#include <nanobind/stl/string.h>

#include "python/src/bindings.h"

namespace mercury::python {
namespace {

ParameterValue value_from(const GeneratorParameter& parameter, nb::handle value) {
  return std::visit(
      [&]<class Value>(const Value&) -> ParameterValue {
        if constexpr (std::is_same_v<Value, SizeRange> || std::is_same_v<Value, std::vector<int>>)
          throw nb::type_error(("the parameter " + parameter.name + " cannot be given yet").c_str());
        else
          return nb::cast<Value>(value);
      },
      parameter.initial);
}

nb::list random_robots(const Generator& generator, std::size_t count, std::uint64_t seed, std::uint64_t first,
                       const nb::kwargs& values) {
  RandomRobots request{.kind = generator.kind, .count = count, .seed = seed, .first = first};
  for (const auto [key, value] : values) {
    const auto name = nb::cast<std::string>(key);
    const auto parameter = std::ranges::find(generator.parameters, name, &GeneratorParameter::name);
    if (parameter == generator.parameters.end()) throw nb::type_error(("there is no parameter " + name).c_str());
    request.values.emplace(name, value_from(*parameter, value));
  }
  std::vector<Robot> robots;
  {
    const nb::gil_scoped_release release;
    robots = make_random_robots(request);
  }
  nb::list list;
  for (Robot& robot : robots) list.append(nb::cast(SharedRobot{std::make_shared<const Robot>(std::move(robot))}));
  return list;
}

}  // namespace

void bind_generators(nb::module_& module) {
  const std::pair<const char*, const char*> functions[] = {
      {"random_voxel", "voxel"}, {"random_network", "nn"}, {"random_shell", "shell"}, {"random_painted", "cppn"}};
  for (const auto& [function, kind] : functions) {
    const Generator& generator = generator_named(kind);
    module.def(
        function,
        [&generator](std::size_t count, std::uint64_t seed, std::uint64_t first, const nb::kwargs& values) {
          return random_robots(generator, count, seed, first, values);
        },
        nb::arg("count") = 1, nb::arg("seed") = 1, nb::arg("first") = 0, nb::arg("parameters"));
  }
}

}  // namespace mercury::python
