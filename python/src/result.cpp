// SPDX-License-Identifier: Apache-2.0
#include "python/src/result.h"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "mercury/quantity.h"
#include "mercury/spread.h"
#include "python/src/arguments.h"
#include "python/src/array.h"
#include "python/src/bindings.h"

namespace mercury::python {
namespace {

bool was_stepped(const Result& self) { return self.was_stepped(); }

// value(evaluation) of each trial.
template <class Value>
std::vector<double> of_trials(const Result& self, const Value& value) {
  std::vector<double> values{static_cast<double>(value(self.evaluation))};
  for (const Evaluation& trial : self.more) values.push_back(static_cast<double>(value(trial)));
  return values;
}

bool has_exploded(const Result& self) {
  return self.evaluation.end.exploded ||
         std::ranges::any_of(self.more, [](const Evaluation& trial) { return trial.end.exploded; });
}

std::vector<double> values_of(const Result& self, const Quantity& quantity) {
  return of_trials(self, [&](const Evaluation& trial) {
    return quantity.value({*trial.robot, trial, self.request->configuration});
  });
}

// How far an exploded robot was thrown means nothing, so it must not win.
bool has_figures(const Result& self) { return was_stepped(self) && !has_exploded(self); }

Spread distances(const Result& self) {
  if (!has_figures(self)) return {.lower_quartile = 0, .median = 0, .upper_quartile = 0};
  return spread_of(values_of(self, quantities()[*find_quantity("distance")]));
}
double distance(const Result& self) { return distances(self).median; }

nb::dict all_quantities(const Result& self) {
  nb::dict values;
  if (!was_stepped(self)) return values;
  for (const Quantity& each : quantities())
    if (has_figures(self) || each.of_body)
      values[nb::str(each.name.data(), each.name.size())] = together(each, values_of(self, each));
  return values;
}

nb::list trials(const Result& self) {
  nb::list all;
  std::size_t number = self.trial;
  const auto add = [&](const Evaluation& trial) {
    all.append(nb::cast(Result{trial, {}, self.request, self.has_hash, self.has_state, number++}));
  };
  add(self.evaluation);
  for (const Evaluation& trial : self.more) add(trial);
  return all;
}

nb::object record(const Telemetry& telemetry) { return telemetry_array(std::span(&telemetry, 1))[0]; }

std::string represent_result(const Result& self) {
  const std::string robot = "<Result " + std::to_string(self.evaluation.index) + ": ";
  if (!was_stepped(self)) return robot + self.evaluation.failure + ">";
  return robot + nb::str(nb::handle(nb::cast(distance(self)))).c_str() + " m in " +
         std::to_string(self.evaluation.steps) + " steps" + (has_exploded(self) ? ", exploded>" : ">");
}

// Of a member of Evaluation.
template <class Member>
auto value_of(Member member) {
  return [member](const Result& self) { return self.evaluation.*member; };
}

// The median of a member of all trials.
auto median_value(double Evaluation::*member) {
  return [member](const Result& self) {
    return median_of(of_trials(self, [&](const Evaluation& trial) { return trial.*member; }));
  };
}

}  // namespace

std::vector<const Result*> results_of(nb::handle what) {
  std::vector<const Result*> results;
  if (nb::isinstance<Result>(what)) results.push_back(nb::cast<const Result*>(what));
  if (!nb::isinstance<nb::list>(what) && !nb::isinstance<nb::tuple>(what)) return results;
  for (const nb::handle one : nb::borrow<nb::sequence>(what)) {
    if (!nb::isinstance<Result>(one)) return {};
    results.push_back(nb::cast<const Result*>(one));
  }
  return results;
}

Repetition repetition_of(const std::vector<const Result*>& results) {
  const Result& first = *results.front();
  SharedRobots robots;
  for (const Result* result : results) {
    const std::string which = "result " + std::to_string(result->evaluation.index);
    if (!result->was_stepped()) throw InputError(which + ": its robot was not stepped: " + result->evaluation.failure);
    if (result->request->drive)
      throw InputError(which + ": it was driven by signals, which are not kept; record a driven Batch with Recorder");
    if (result->request != first.request || result->evaluation.steps != first.evaluation.steps)
      throw InputError(which + ": it is of another call of evaluate(), or of a trial of another length, than result " +
                       std::to_string(first.evaluation.index) + "; take them one by one");
    robots.push_back(result->evaluation.robot);
  }
  Simulation simulation(first.request->configuration, robots);
  if (first.request->start) {
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      std::vector<Vec3> own = robots[i]->masses;
      first.request->start(results[i]->trial, *robots[i], own);
      positions.insert(positions.end(), own.begin(), own.end());
    }
    simulation.reset_to(positions);
  }
  if (first.request->noise_seed)
    for (std::size_t i = 0; i < robots.size(); ++i)
      simulation.set_noise_seed(i, first.request->noise_seed(results[i]->trial));
  const auto steps = static_cast<double>(first.request->settling + first.evaluation.steps);
  return {std::move(simulation), steps * first.request->configuration.dt};
}

void bind_result(nb::module_& module) {
  nb::class_<Result>(
      module, "Result",
      "What became of one robot in evaluate(). Numbers of several trials are medians; start, end, hash and "
      "the final\nstate are those of the first. All numbers are 0 if `failure` says that the robot could "
      "not be stepped.")
      .def_prop_ro("index", value_of(&Evaluation::index), "Of the robot in the source.")
      .def_prop_ro(
          "robot",
          [](const Result& self) {
            return self.evaluation.robot ? nb::cast(SharedRobot{self.evaluation.robot}) : nb::none();
          },
          nb::sig("def robot(self) -> Robot | typing.Any"),
          "The robot; None if the source raised InputError instead of giving one.")
      .def_prop_ro(
          "failure",
          [](const Result& self) {
            return self.evaluation.failure.empty() ? nb::none() : nb::cast(self.evaluation.failure);
          },
          nb::sig("def failure(self) -> str | None"), "Why the robot cannot be used, one line; None if it was stepped.")
      .def_prop_ro("steps", value_of(&Evaluation::steps), "Steps of the trial after settling.")
      .def_prop_ro(
          "start", [](const Result& self) { return record(self.evaluation.start); },
          nb::sig("def start(self) -> numpy.void"),
          "Telemetry after settling: a record with the fields of Batch.telemetry().")
      .def_prop_ro(
          "end", [](const Result& self) { return record(self.evaluation.end); }, nb::sig("def end(self) -> numpy.void"),
          "Telemetry at the end, as `start`.")
      .def_prop_ro("distance", &distance,
                   "How far the center of mass went from start to end; on land along the ground [m]. 0 if the robot "
                   "exploded, so\nthat it never leads a ranking.")
      .def_prop_ro(
          "quartiles",
          [](const Result& self) {
            const Spread spread = distances(self);
            return nb::make_tuple(spread.lower_quartile, spread.upper_quartile);
          },
          nb::sig("def quartiles(self) -> tuple[float, float]"),
          "Lower and upper quartile of the trials' distances [m].")
      .def_prop_ro("trials", &trials, nb::sig("def trials(self) -> list[Result]"),
                   "Each trial as a Result of its own; of one trial a list of one.")
      .def_prop_ro("path", median_value(&Evaluation::path),
                   "Length of the path of the center of mass, from sample to sample [m].")
      .def_prop_ro("work", median_value(&Evaluation::work), "That the muscles did, from sample to sample [J].")
      .def_prop_ro("highest", median_value(&Evaluation::highest), "Largest z of the center of mass of all samples [m].")
      .def_prop_ro("largest_strain", median_value(&Evaluation::largest_strain),
                   "Largest strain of a spring of all samples [1].")
      .def_prop_ro("strained_share", median_value(&Evaluation::strained_share),
                   "Largest share of the springs that were strained by more than half at the same time [1].")
      .def_prop_ro("inverted", median_value(&Evaluation::inverted),
                   "Largest share of the body that was inside out [1]; NaN unless evaluate(folding=True).")
      .def_prop_ro("overlap", median_value(&Evaluation::overlap),
                   "Largest share of the masses that were within other parts of the body [1]; NaN unless "
                   "evaluate(folding=True).")
      .def_prop_ro("upright", median_value(&Evaluation::upright),
                   "Cosine between the body's up axis and the vertical, mean over the trial [1]; NaN unless "
                   "evaluate(upright=True).")
      .def_prop_ro("exploded", &has_exploded, "Whether the robot left the finite in a trial and was frozen.")
      .def_prop_ro(
          "quantities", &all_quantities, nb::sig("def quantities(self) -> dict[str, float]"),
          "All quantities that `mercury evolve` knows, by name: speed, efficiency, body_lengths, ... Of a robot "
          "that\nexploded only those of its body; empty if the robot could not be stepped.")
      .def_prop_ro(
          "hash",
          [](const Result& self) {
            return self.has_hash && was_stepped(self) ? nb::cast(self.evaluation.hash) : nb::none();
          },
          nb::sig("def hash(self) -> int | None"),
          "Batch.hash() of the final state; None unless evaluate(hashes=True).")
      .def_prop_ro(
          "positions",
          [](const Result& self) {
            return self.has_state && was_stepped(self) ? vector_array(self.evaluation.state.positions) : nb::none();
          },
          nb::sig("def positions(self) -> numpy.typing.NDArray[numpy.float32] | typing.Any"),
          "Final positions, (masses, 3) float32 [m], a NumPy array; None unless evaluate(states=True).")
      .def_prop_ro(
          "velocities",
          [](const Result& self) {
            return self.has_state && was_stepped(self) ? vector_array(self.evaluation.state.velocities) : nb::none();
          },
          nb::sig("def velocities(self) -> numpy.typing.NDArray[numpy.float32] | typing.Any"),
          "Final velocities, (masses, 3) float32 [m/s]; as positions.")
      .def("__repr__", &represent_result);
}

}  // namespace mercury::python
