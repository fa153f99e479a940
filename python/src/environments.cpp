// SPDX-License-Identifier: Apache-2.0
// Ocean, OceanSimple and Land, from the parameter tables of mercury/configuration.h.
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>

#include "mercury/configuration.h"
#include "mercury/error.h"
#include "python/src/bindings.h"

namespace mercury::python {
namespace {

nb::object to_python(Vec3 value) { return nb::make_tuple(value.x, value.y, value.z); }
template <class Value>
nb::object to_python(Value value) {
  return nb::cast(value);
}

void set(Vec3& to, nb::handle value) {
  float* const axes[] = {&to.x, &to.y, &to.z};
  if (nb::len(value) != 3) throw nb::type_error("three numbers (x, y, z) are needed");
  for (std::size_t i = 0; i < 3; ++i) *axes[i] = nb::cast<float>(value[i]);
}
template <class Value>
void set(Value& to, nb::handle value) {
  to = nb::cast<Value>(value);
}

template <class Kind>
void bind(nb::module_& module, const char* name) {
  nb::class_<Kind> kind(module, name);
  kind.def(
      "__init__",
      [name](Kind* self, const nb::kwargs& values) {
        new (self) Kind;
        for (const auto [key, value] : values) {
          bool known = false;
          for_each_parameter(*self, [&](const auto& parameter, auto& member) {
            if (nb::cast<std::string_view>(key) != parameter.name) return;
            set(member, value);
            known = true;
          });
          if (!known)
            throw nb::type_error((std::string(name) + " has no parameter " + nb::cast<std::string>(key)).c_str());
        }
        validate({.environment = *self});
      },
      nb::arg("parameters"));
  const Kind defaults;
  for_each_parameter(defaults, [&](const auto& parameter, const auto&) {
    kind.def_prop_ro(std::string(parameter.name).c_str(),
                     [member = parameter.member](const Kind& self) { return to_python(self.*member); });
  });
}

}  // namespace

Environment environment_of(nb::handle environment) {
  if (environment.is_none()) return Ocean{};
  if (nb::isinstance<nb::str>(environment)) return environment_named(nb::cast<std::string>(environment));
  Environment result;
  bool known = false;
  for_each_environment([&]<class Kind>(const Kind&) {
    if (!nb::isinstance<Kind>(environment)) return;
    result = nb::cast<Kind>(environment);
    known = true;
  });
  if (!known) throw nb::type_error("an environment is an Ocean, OceanSimple or Land, or one of their names");
  return result;
}

void bind_environments(nb::module_& module) {
  bind<Ocean>(module, "Ocean");
  bind<OceanSimple>(module, "OceanSimple");
  bind<Land>(module, "Land");
}

}  // namespace mercury::python
