// SPDX-License-Identifier: Apache-2.0
// Environment and a class per preset, from the tables of mercury/environment.h.
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <cctype>

#include "mercury/configuration.h"
#include "mercury/environment.h"
#include "mercury/error.h"
#include "mercury/names.h"
#include "mercury/number_text.h"
#include "python/src/arguments.h"
#include "python/src/bindings.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

nb::object to_python(float value) { return nb::float_(shortest(value)); }
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

// What Python has. Each preset is a class of its own, which never changes its parts.
struct Combination {
  Environment environment;
};
template <std::size_t preset>
struct Preset : Combination {};

using Presets = std::make_index_sequence<environment_presets.size()>;

// "ocean-simple" -> "OceanSimple"
const char* class_name(std::size_t preset) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> made;
    for (const EnvironmentPreset& named : environment_presets) {
      std::string name;
      bool begins = true;
      for (const char letter : named.name) {
        if (letter != '-')
          name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(letter))) : letter;
        begins = letter == '-';
      }
      made.push_back(name);
    }
    return made;
  }();
  return names[preset].c_str();
}

// The class of an environment, or "Environment" for a combination that no preset has.
std::string class_of(const Environment& environment) {
  for (std::size_t i = 0; i < environment_presets.size(); ++i)
    if (same_parts(environment_presets[i].environment, environment)) return class_name(i);
  return "Environment";
}

std::vector<std::string> parameter_names(const Environment& environment) {
  std::vector<std::string> names;
  for_each_parameter(environment, [&](const auto& parameter, const auto&) { names.emplace_back(parameter.name); });
  return names;
}

// Errors name the class and the parameter: "Ocean: density: must be a number, not str".
Environment changed(Environment environment, const nb::kwargs& values) {
  const std::string kind = class_of(environment);
  for (const auto [key, value] : values) {
    const std::string name = text_from(kind, key);
    bool known = false;
    for_each_parameter(environment, [&](const auto& parameter, auto& member) {
      if (name != parameter.name) return;
      set(kind + ": " + name, parameter, member, value);
      known = true;
    });
    if (!known)
      throw nb::type_error(
          (kind + " has no parameter " + name + suggestion(name, parameter_names(environment))).c_str());
  }
  try {
    validate({.environment = environment});
  } catch (const ParameterError& error) {
    throw ParameterError(kind + ": " + error.parameter(), error.problem());
  }
  return environment;
}
Environment changed(const Environment& environment, const nb::dict& values) {
  return changed(environment, nb::steal<nb::kwargs>(PyDict_Copy(values.ptr())));
}

nb::dict values_of(const Environment& environment) {
  nb::dict values;
  for_each_parameter(environment, [&](const auto& parameter, const auto& member) {
    values[std::string(parameter.name).c_str()] = to_python(member);
  });
  return values;
}

// Ocean(density=1000.0, ...), or Environment('ocean+ground', density=1000.0, ...)
nb::str repr(const Environment& environment) {
  const std::string kind = class_of(environment);
  std::string text = kind + "(";
  if (kind == "Environment") text += "'" + std::string(name_of(environment)) + "'";
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
std::string parameter_list(const Environment& defaults, bool with_defaults) {
  std::string text;
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

template <std::size_t preset>
void bind_preset(nb::module_& module) {
  using Kind = Preset<preset>;
  const EnvironmentPreset& named = environment_presets[preset];
  const Environment& defaults = named.environment;
  std::string documentation =
      "An environment: " + std::string(named.help) + ". It never changes; replace() makes copies.\n\n";
  for_each_parameter(defaults, [&](const auto& parameter, const auto& value) {
    documentation += std::string(parameter.name) + ": " + documentation_of(parameter) + " (default " +
                     nb::cast<std::string>(nb::repr(to_python(value))) +
                     (parameter.takes_downward_magnitude ? "; one number g stands for (0, 0, -g))\n" : ")\n");
  });
  const std::string init = "def __init__(self, *" + parameter_list(defaults, true) + ") -> None";

  nb::class_<Kind, Combination> kind(module, class_name(preset), documentation.c_str());
  kind.def(
          "__init__",
          [](Kind* self, const nb::kwargs& values) {
            new (self) Kind{changed(environment_presets[preset].environment, values)};
          },
          nb::arg("parameters"), nb::sig(init.c_str()))
      .def(
          "__getstate__", [](const Kind& self) { return values_of(self.environment); },
          nb::sig("def __getstate__(self) -> typing.Any"))
      .def(
          "__setstate__",
          [](Kind& self, const nb::dict& values) {
            new (&self) Kind{changed(environment_presets[preset].environment, values)};
          },
          nb::arg("state"), nb::sig("def __setstate__(self, state: typing.Any, /) -> None"));
  for (const char* method : {"replace", "__replace__"}) {
    const std::string signature = "def " + std::string(method) + "(self, *" + parameter_list(defaults, false) +
                                  ", **parameters: typing.Any) -> " + class_name(preset);
    kind.def(
        method, [](const Kind& self, const nb::kwargs& values) { return Kind{changed(self.environment, values)}; },
        nb::arg("parameters"), nb::sig(signature.c_str()), "A copy with other values.");
  }
  for_each_parameter(defaults, [&](const auto& parameter, const auto& value) {
    const std::string property(parameter.name),
        property_signature = "def " + property + "(self) -> " + type_hint(value);
    kind.def_prop_ro(
        property.c_str(),
        [property](const Kind& self) -> nb::object { return values_of(self.environment)[property.c_str()]; },
        nb::sig(property_signature.c_str()), documentation_of(parameter).c_str());
  });
}

void bind_combination(nb::module_& module) {
  const std::vector<std::string_view> presets = environment_names();
  const std::string documentation = R"(An environment of any parts. It never changes; replace() makes copies.

    pool = mercurysim.Environment("ocean+ground+contacts", gravity=2, friction=0.5)

name: a preset ()" + mercury::list_of({presets.begin(), presets.end()}) +
                                    R"() or space, followed by +ground or +contacts or both.
parameters: those of the parts, as the classes of the presets have them.)";
  nb::class_<Combination> kind(module, "Environment", documentation.c_str());
  kind.def(
          "__init__",
          [](Combination* self, const std::string& name, const nb::kwargs& values) {
            new (self) Combination{changed(environment_named(name), values)};
          },
          nb::arg("name"), nb::arg("parameters"),
          nb::sig("def __init__(self, name: str, **parameters: typing.Any) -> None"))
      .def_prop_ro(
          "name", [](const Combination& self) { return std::string(name_of(self.environment)); }, "Its parts.")
      .def("__repr__", [](const Combination& self) { return repr(self.environment); })
      .def(
          "__eq__",
          [](const Combination& self, nb::handle other) -> nb::object {
            if (!nb::isinstance<Combination>(other)) return nb::borrow(nb::handle(Py_NotImplemented));
            return nb::bool_(self.environment == nb::cast<const Combination&>(other).environment);
          },
          nb::arg("other").none(), nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__hash__", [](const Combination& self) { return nb::hash(repr(self.environment)); })
      .def(
          "__getattr__",
          [](const Combination& self, const std::string& name) -> nb::object {
            const nb::dict values = values_of(self.environment);
            if (!values.contains(name.c_str()))
              throw nb::attribute_error((class_of(self.environment) + " has no parameter " + name).c_str());
            return values[name.c_str()];
          },
          nb::arg("name"), nb::sig("def __getattr__(self, name: str, /) -> typing.Any"))
      .def(
          "__getstate__",
          [](const Combination& self) {
            return nb::make_tuple(std::string(name_of(self.environment)), values_of(self.environment));
          },
          nb::sig("def __getstate__(self) -> typing.Any"))
      .def(
          "__setstate__",
          [](Combination& self, const nb::tuple& state) {
            new (&self)
                Combination{changed(environment_named(nb::cast<std::string>(state[0])), nb::cast<nb::dict>(state[1]))};
          },
          nb::arg("state"), nb::sig("def __setstate__(self, state: typing.Any, /) -> None"));
  for (const char* method : {"replace", "__replace__"}) {
    const std::string signature = "def " + std::string(method) + "(self, **parameters: typing.Any) -> Environment";
    kind.def(
        method,
        [](const Combination& self, const nb::kwargs& values) {
          return Combination{changed(self.environment, values)};
        },
        nb::arg("parameters"), nb::sig(signature.c_str()), "A copy with other values.");
  }
}

}  // namespace

std::string environment_classes() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < environment_presets.size(); ++i) names.emplace_back(class_name(i));
  names.emplace_back("Environment");
  return mercury::list_of(names, " or ");
}

Environment environment_of(nb::handle environment) {
  if (environment.is_none()) return environment_presets.front().environment;
  if (nb::isinstance<nb::str>(environment)) return environment_named(text_from("environment", environment));
  if (nb::isinstance<Combination>(environment)) return nb::cast<const Combination&>(environment).environment;
  refuse_type("environment", "an Environment such as Ocean or Land, or the name of one", environment);
}

void set_parameters(std::vector<Environment>& environments, const nb::kwargs& values) {
  if (environments.empty()) return;
  const std::size_t count = environments.size();
  const std::string kind = class_of(environments.front());
  for (const auto [key, value] : values) {
    const std::string name = text_from(kind, key);
    bool known = false;
    // The values are read once, with the first environment.
    std::vector<float> numbers;
    std::vector<Vec3> vectors;
    const auto of = [](const auto& all, std::size_t i) { return all.size() == 1 ? all.front() : all[i]; };
    for (std::size_t i = 0; i < count; ++i)
      for_each_parameter(environments[i], [&]<class Value>(const auto& parameter, Value& member) {
        if (name != parameter.name) return;
        known = true;
        if constexpr (std::is_same_v<Value, Vec3>) {
          if (i == 0) vectors = vectors_from(value, count, name, parameter.takes_downward_magnitude);
          member = of(vectors, i);
        } else if constexpr (std::is_same_v<Value, float>) {
          if (i == 0) numbers = numbers_from(value, count, name);
          member = of(numbers, i);
        } else {
          throw InputError(name, "is the same for all robots; use configure()");
        }
      });
    if (!known)
      throw nb::type_error(
          (kind + " has no parameter " + name + suggestion(name, parameter_names(environments.front()))).c_str());
  }
}

nb::object object_of(const Environment& environment) {
  nb::object object;
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    const auto use = [&]<std::size_t preset>() {
      if (!object.is_valid() && same_parts(environment_presets[preset].environment, environment))
        object = nb::cast(Preset<preset>{environment});
    };
    (use.template operator()<i>(), ...);
  }
  (Presets{});
  return object.is_valid() ? object : nb::cast(Combination{environment});
}

void bind_environments(nb::module_& module) {
  bind_combination(module);
  [&]<std::size_t... i>(std::index_sequence<i...>) { (bind_preset<i>(module), ...); }
  (Presets{});
}

}  // namespace mercury::python
