// SPDX-License-Identifier: Apache-2.0
// Ocean, OceanSimple and Land, from the parameter tables of mercury/configuration.h.
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <charconv>

#include "mercury/configuration.h"
#include "mercury/error.h"
#include "python/src/bindings.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

// The shortest number in double precision that is this one in single precision: 0.2, not 0.20000000298.
nb::object to_python(float value) {
  char room[32];
  const char* end = std::to_chars(room, room + sizeof room, value).ptr;
  double number = 0;
  std::from_chars(room, end, number);
  return nb::float_(number);
}
nb::object to_python(bool value) { return nb::bool_(value); }
nb::object to_python(Vec3 value) { return nb::make_tuple(to_python(value.x), to_python(value.y), to_python(value.z)); }

void set(const std::string& name, const auto&, float& to, nb::handle value) {
  to = static_cast<float>(number_from(name, value));
}
void set(const std::string& name, const auto&, bool& to, nb::handle value) { to = bool_from(name, value); }
void set(const std::string& name, const auto& parameter, Vec3& to, nb::handle value) {
  const std::string wanted = std::string("three numbers (x, y, z)") +
                             (parameter.takes_downward_magnitude ? ", or one number for (0, 0, -number)" : "");
  if (!nb::isinstance<nb::iterable>(value) || PyUnicode_Check(value.ptr())) {
    if (!parameter.takes_downward_magnitude || PyUnicode_Check(value.ptr())) refuse_type(name, wanted, value);
    to = {0, 0, -static_cast<float>(number_from(name, value))};
    return;
  }
  std::vector<float> numbers;
  for (const nb::handle number : value) {
    numbers.push_back(static_cast<float>(number_from(name, number)));
    if (numbers.size() > 3) throw InputError(name, "more than 3 numbers are not accepted; give " + wanted);
  }
  if (numbers.size() < 3)
    throw InputError(name, std::to_string(numbers.size()) + " numbers are not accepted; give " + wanted);
  to = {numbers[0], numbers[1], numbers[2]};
}

template <class Kind>
std::vector<std::string> parameter_names() {
  std::vector<std::string> names;
  const Kind defaults;
  for_each_parameter(defaults, [&](const auto& parameter, const auto&) { names.emplace_back(parameter.name); });
  return names;
}

// Errors name the environment and the parameter: "Ocean: density: must be a number, not str".
template <class Kind>
Kind changed(const std::string& kind, Kind environment, const nb::kwargs& values) {
  for (const auto [key, value] : values) {
    const std::string name = text_from(kind, key);
    bool known = false;
    for_each_parameter(environment, [&](const auto& parameter, auto& member) {
      if (name != parameter.name) return;
      set(kind + ": " + name, parameter, member, value);
      known = true;
    });
    if (!known)
      throw nb::type_error((kind + " has no parameter " + name + suggestion(name, parameter_names<Kind>())).c_str());
  }
  try {
    validate({.environment = environment});
  } catch (const ParameterError& error) {
    throw ParameterError(kind + ": " + error.parameter(), error.problem());
  }
  return environment;
}

template <class Kind>
nb::dict values_of(const Kind& environment) {
  nb::dict values;
  for_each_parameter(environment, [&](const auto& parameter, const auto& member) {
    values[std::string(parameter.name).c_str()] = to_python(member);
  });
  return values;
}

template <class Kind>
nb::str repr(const std::string& kind, const Kind& environment) {
  std::string text = kind + "(";
  for (const auto [key, value] : values_of(environment))
    text +=
        (text.ends_with('(') ? "" : ", ") + nb::cast<std::string>(key) + "=" + nb::cast<std::string>(nb::repr(value));
  return nb::str((text + ")").c_str());
}

template <class Value>
std::string type_hint(const Value&) {
  return std::is_same_v<Value, bool> ? "bool" : std::is_same_v<Value, Vec3> ? "tuple[float, float, float]" : "float";
}

// "density: float = 1000.0, ..."; of a copy, "density: float = ..."
template <class Kind>
std::string parameter_list(bool with_defaults) {
  std::string text;
  const Kind defaults;
  for_each_parameter(defaults, [&]<class Value>(const auto& parameter, const Value& value) {
    std::string hint = std::is_same_v<Value, Vec3> ? "collections.abc.Iterable[float]" : type_hint(value);
    if (parameter.takes_downward_magnitude) hint = "float | " + hint;
    text += ", " + std::string(parameter.name) + ": " + hint + " = " +
            (with_defaults ? nb::cast<std::string>(nb::repr(to_python(value))) : "...");
  });
  return text;
}

template <class Parameter>
std::string documentation_of(const Parameter& parameter) {
  std::string text(parameter.help);
  if (!parameter.unit.empty()) text += " [" + std::string(parameter.unit) + "]";
  return text;
}

template <class Kind>
void bind(nb::module_& module, const char* name) {
  std::string documentation =
      "An environment: " + std::string(Kind::help) + ". It never changes; replace() makes copies.\n\n";
  const Kind defaults;
  for_each_parameter(defaults, [&](const auto& parameter, const auto& value) {
    documentation += std::string(parameter.name) + ": " + documentation_of(parameter) + " (default " +
                     nb::cast<std::string>(nb::repr(to_python(value))) +
                     (parameter.takes_downward_magnitude ? "; one number g stands for (0, 0, -g))\n" : ")\n");
  });
  const std::string init = "def __init__(self, *" + parameter_list<Kind>(true) + ") -> None";
  const auto replaced = [name](const Kind& self, const nb::kwargs& values) { return changed(name, self, values); };

  nb::class_<Kind> kind(module, name, documentation.c_str());
  kind.def(
          "__init__", [name](Kind* self, const nb::kwargs& values) { new (self) Kind(changed(name, Kind{}, values)); },
          nb::arg("parameters"), nb::sig(init.c_str()))
      .def("__repr__", [name](const Kind& self) { return repr(name, self); })
      .def(
          "__eq__",
          [](const Kind& self, nb::handle other) -> nb::object {
            Kind second;
            if (!nb::try_cast(other, second)) return nb::borrow(nb::handle(Py_NotImplemented));
            return nb::bool_(self == second);
          },
          nb::arg("other").none(), nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__hash__", [name](const Kind& self) { return nb::hash(repr(name, self)); })
      .def("__getstate__", &values_of<Kind>, nb::sig("def __getstate__(self) -> dict[str, typing.Any]"))
      .def(
          "__setstate__",
          [name](Kind& self, const nb::dict& values) {
            new (&self) Kind(changed(name, Kind{}, nb::steal<nb::kwargs>(PyDict_Copy(values.ptr()))));
          },
          nb::arg("state"), nb::sig("def __setstate__(self, state: dict[str, typing.Any], /) -> None"));
  for (const char* method : {"replace", "__replace__"}) {
    const std::string signature =
        "def " + std::string(method) + "(self, *" + parameter_list<Kind>(false) + ") -> " + name;
    kind.def(method, replaced, nb::arg("parameters"), nb::sig(signature.c_str()), "A copy with other values.");
  }
  for_each_parameter(defaults, [&](const auto& parameter, const auto& value) {
    const std::string property(parameter.name),
        property_signature = "def " + property + "(self) -> " + type_hint(value);
    kind.def_prop_ro(
        property.c_str(), [member = parameter.member](const Kind& self) { return to_python(self.*member); },
        nb::sig(property_signature.c_str()), documentation_of(parameter).c_str());
  });
}

}  // namespace

Environment environment_of(nb::handle environment) {
  if (environment.is_none()) return Ocean{};
  if (nb::isinstance<nb::str>(environment)) return environment_named(text_from("environment", environment));
  Environment result;
  bool known = false;
  for_each_environment([&]<class Kind>(const Kind&) {
    Kind of_this_kind;
    if (!nb::try_cast(environment, of_this_kind)) return;
    result = of_this_kind;
    known = true;
  });
  if (!known) refuse_type("environment", "an Ocean, OceanSimple or Land, or one of their names", environment);
  return result;
}

void bind_environments(nb::module_& module) {
  bind<Ocean>(module, "Ocean");
  bind<OceanSimple>(module, "OceanSimple");
  bind<Land>(module, "Land");
}

}  // namespace mercury::python
