// SPDX-License-Identifier: Apache-2.0
// The parts of the module _mercury, one per file, and the types that they share.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/generator.h"
#include "mercury/robot.h"

namespace mercury {
struct EvolutionSettings;
struct GenomeSpaceRequest;
}  // namespace mercury

namespace mercury::python {

namespace nb = nanobind;

// A robot as Python has it: it never changes, so batches share it.
struct SharedRobot {
  std::shared_ptr<const Robot> robot;
};

using SharedRobots = std::vector<std::shared_ptr<const Robot>>;

// The robots of a Robot, or of a sequence of them. Throws TypeError.
SharedRobots robots_of(nb::handle robots);

// The environment of an Environment, or of a name; None = Ocean(). Throws TypeError, InputError.
Environment environment_of(nb::handle environment);
// The reverse: of the class of the preset, or an Environment.
nb::object object_of(const Environment& environment);

// "Ocean, OceanSimple, Land, Water or Environment": their classes.
std::string environment_classes();

// Sets parameters of environments of the same parts: one value for all, or one per environment. Throws TypeError,
// InputError.
void set_parameters(std::vector<Environment>& environments, const nb::kwargs& values);

// What Batch and evaluate() are given. `device` = a name, or anything whose str() is one. Throws TypeError, InputError.
Configuration configuration_of(nb::handle environment, const std::string& solver, double dt, double damping,
                               nb::handle device, int threads);

// The settings of a search among these genomes, from the keyword arguments of evolution.py; sets the environment of
// the genomes. Throws TypeError for a name that is none, InputError for a value that cannot be used.
EvolutionSettings settings_from(const nb::dict& given, GenomeSpaceRequest& space);

// Parameters of a generator from keyword arguments; `function` is named in errors. Throws TypeError, InputError.
ParameterValues generator_values(const std::string& function, const Generator& generator, const nb::kwargs& given);

// __reduce_ex__ of objects that cannot be pickled or copied: raises TypeError.
inline const nb::sig refused_pickle_signature(
    "def __reduce_ex__(self, protocol: object, /) -> str | tuple[typing.Any, ...]");
inline auto refused_pickle(const char* reason) {
  return [reason](nb::handle, nb::handle) -> nb::object { throw nb::type_error(reason); };
}

// Lets other threads of Python run until its end. A daemon thread that comes back while the interpreter exits sleeps
// instead: Python would end the thread in the middle of C++ functions, and with it the process.
class ReleasedGil {
 public:
  ReleasedGil();
  ~ReleasedGil();
  ReleasedGil(const ReleasedGil&) = delete;
  ReleasedGil& operator=(const ReleasedGil&) = delete;

 private:
  PyThreadState* state_;
};

// Notices when the interpreter exits.
void watch_exit();

void bind_errors(nb::module_& module);
void bind_robot(nb::module_& module);
void bind_generators(nb::module_& module);
void bind_voxel(nb::module_& module);
void bind_environments(nb::module_& module);
void bind_array(nb::module_& module);
void bind_batch(nb::module_& module);
void bind_brains(nb::module_& module);
void bind_evaluate(nb::module_& module);
void bind_evolution(nb::module_& module);
void bind_run_history(nb::module_& module);
void bind_pictures(nb::module_& module);
void bind_recording(nb::module_& module);
void bind_export(nb::module_& module);

}  // namespace mercury::python
