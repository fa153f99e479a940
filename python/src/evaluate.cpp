// SPDX-License-Identifier: Apache-2.0
// evaluate(): robots in, results out.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "mercury/evaluator.h"
#include "mercury/trials.h"
#include "python/src/bindings.h"
#include "python/src/called_object.h"
#include "python/src/drives.h"
#include "python/src/result.h"
#include "python/src/robot_source.h"

namespace mercury::python {
namespace {

using std::chrono::milliseconds;

constexpr const char* evaluate_description =
    R"(Tries any number of robots, each for the same time, and keeps the device busy: robots are made and loaded while
others are stepped. Returns an iterator over one Result per robot, in the order of the source.

    for result in mercurysim.evaluate(mercurysim.random_voxel(1000), 10):
        print(result.index, result.distance)

source: Robots, an iterator over them, which may be endless, or a function that returns the Robot of an index, None from
the end on. An iterator runs in the thread that waits for results, some hundred robots ahead of them; robots that depend
on results before need one call of evaluate() per generation. A function is called by several threads at the same time,
in no particular order: use it where C++ does the work, as in lambda i: mercurysim.random_network(1, first=i)[0].
seconds: simulated time per robot, settling included [s].
settle: at its start; nothing is measured before [s].
sample_every: time between two samples [s]; path, work, highest and the strains are as good as they are dense. None =
0.05 s.
environment, solver, dt, damping, device, threads: as in Batch; with "cuda:all", each robot goes to one of the devices.
trials, jitter: how often each robot is tried, with masses that begin displaced by a normal deviate of this standard
deviation per coordinate, per shortest rest length; numbers are medians. None = 0.001 with several trials, else 0.
target_radius, target_spread: each trial starts at this distance from the environment's target, in a random direction,
or nearer by up to this share of it [m]; 0 = where the robot has its masses. quantities["reached"] is the share of the
trials that came within the environment's `reach` of it.
target_sphere: whether the direction may point up and down.
turned: whether each trial starts turned about the vertical by a random angle.
delay, noise, damage: all trials but the first start at random moments of the muscles' movement, up to `delay` [s];
stiffnesses and amplitudes differ between trials by the standard deviation `noise`; each trial lacks the share `damage` of
the voxels. Result.robot is the robot of the first trial.
seed: of all of that, which is the same for all robots. Senses have other noise in each trial.
drives, drive_every: signals for the actuators (Batch.actuation), from -1 to 1: an array (periods, actuators) for all
robots, a list of them, one per robot, or a function of index and Robot that returns one. A period lasts `drive_every` [s],
settling included; after the last one the first one follows. A column of NaN leaves an actuator to its sine or brain.
checks, goes_on: racing. At each of these times after settling [s], goes_on(so_far) is asked about every robot, whose
Result is what it would be if its trial ended there. Where it returns False, it does end there (Result.steps), and its steps
are saved; results of others are the same bit for bit. With one trial per robot. Several threads call the function, in no
particular order, so it has to depend on `so_far` alone.
folding: whether results have `inverted` and `overlap`, which take all positions from the device.
upright: whether results have `upright`, which takes them, too.
hashes, states: whether results have the hash and the masses of the final state.
memory_limit: of the host, for robots that are made and not yet returned [bytes]; None = a quarter of what is free.
portion: how many robots are loaded together, at most; None = chosen. Results do not depend on it.

What the source raises comes out of next(), after the results before. A robot that breaks a rule, or an InputError of a
function, is a Result with `failure`. Raises InputError for a value that is not accepted.)";

// An iterator over results, as Python has it. One thread at a time takes results; close() may come from another one.
// All functions are called with the GIL, which guards the members.
class Results {
 public:
  // `drives` may be null.
  Results(const EvaluationRequest& request, nb::object source, const TrialSettings& trials, std::uint64_t seed,
          std::shared_ptr<const Drives> drives);
  ~Results() { close(); }
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  Result next();  // throws StopIteration
  // Ends the evaluation. A thread that is in next() notices within a twentieth of a second.
  void close();
  std::vector<std::string> notes() const;

  // For Python's garbage collector.
  std::array<nb::handle, 2> references() const { return {source_, iterator_}; }
  void forget_references() { source_.reset(), iterator_.reset(); }

 private:
  class Use;

  void pull();
  std::optional<Result> wait();

  const std::size_t trials_;
  std::shared_ptr<const EvaluationRequest> request_;
  bool hashes_, states_;
  std::vector<Evaluation> collected_;  // trials of the next robot
  std::shared_ptr<const Drives> drives_;
  nb::object source_, iterator_;
  std::size_t pulled_robots_ = 0;
  std::shared_ptr<PulledSource> pulled_;  // null unless robots come from an iterator
  std::shared_ptr<SourceError> error_ = std::make_shared<SourceError>();
  std::shared_ptr<Evaluator> evaluator_;  // null once it is closed
  std::vector<std::string> notes_;        // from then on
  std::thread::id user_;                  // that is in next()
  const pid_t process_ = getpid();        // whose threads try the robots
};

// The thread that is in next().
class Results::Use {
 public:
  explicit Use(Results& results) : results_(results) {
    if (results.user_ != std::thread::id()) throw nb::value_error("another call of next() has not returned yet");
    results.user_ = std::this_thread::get_id();
  }
  ~Use() { results_.user_ = {}; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  Results& results_;
};

Results::Results(const EvaluationRequest& request, nb::object source, const TrialSettings& trials, std::uint64_t seed,
                 std::shared_ptr<const Drives> drives)
    : trials_(static_cast<std::size_t>(trials.trials)), request_(std::make_shared<EvaluationRequest>(request)),
      hashes_(request.hashes), states_(request.states), drives_(std::move(drives)), source_(std::move(source)) {
  EvaluationRequest complete = request;
  RobotSource robots;
  std::size_t count = Evaluator::unknown_count;
  if (nb::isinstance<SharedRobot>(source_) || nb::isinstance<nb::list>(source_) || nb::isinstance<nb::tuple>(source_)) {
    SharedRobots all = robots_of(source_);
    count = all.size();
    robots = source_of(std::move(all));
  } else if (PyObject* const iterator = PyObject_GetIter(source_.ptr())) {
    iterator_ = nb::steal(iterator);
    pulled_ = std::make_shared<PulledSource>();
    complete.serial_source = true;
    robots = [pulled = pulled_](std::size_t) { return pulled->take(); };
  } else {
    PyErr_Clear();
    if (!PyCallable_Check(source_.ptr()))
      throw nb::type_error("source: give Robots, an iterator over them, or a function that returns one for an index");
    robots = source_of_function(source_, error_);
  }
  const ReleasedGil released;
  if (count != Evaluator::unknown_count) count *= trials_;
  evaluator_ = std::make_shared<Evaluator>(complete, trial_source(std::move(robots), trials, seed), count);
}

// Takes one robot from the iterator.
void Results::pull() {
  std::shared_ptr<const Robot> robot;
  try {
    const nb::object next = nb::steal(PyIter_Next(iterator_.ptr()));
    if (next.is_valid())
      robot = robot_from(next, pulled_robots_);
    else if (PyErr_Occurred())
      throw nb::python_error();
  } catch (...) {
    error_->keep(pulled_robots_, std::current_exception());
  }
  ++pulled_robots_;
  pulled_->serve(std::move(robot));
  error_->rethrow_if_urgent();
}

// One robot is taken for each result that is there, and as many as are wanted while there is none.
Result Results::next() {
  if (evaluator_ && getpid() != process_)
    throw DeviceError("these results are those of the process that was forked: call evaluate() in this one");
  const Use use(*this);
  while (evaluator_) {
    if (pulled_ && pulled_->is_wanted()) pull();
    if (std::optional<Result> result = wait()) return *std::move(result);
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
  throw nb::stop_iteration();
}

// Nothing if there is no result yet, and after the last one.
std::optional<Result> Results::wait() {
  std::shared_ptr<Evaluator> ours = evaluator_;  // another thread may close
  if (!ours) return std::nullopt;
  std::optional<Evaluation> evaluation;
  bool is_over = false;
  try {
    const ReleasedGil released;
    const std::shared_ptr<Evaluator> evaluator = std::move(ours);
    if (evaluator->wait_for(milliseconds(pulled_ ? 0 : 50))) {
      evaluation = evaluator->next();
      is_over = !evaluation;
    } else if (pulled_) {
      pulled_->wait(milliseconds(1));
    }
  } catch (...) {
    close();
    throw;
  }
  if (is_over) {
    close();
    error_->rethrow();
  }
  if (!evaluation) return std::nullopt;
  collected_.push_back(*std::move(evaluation));
  if (collected_.size() < trials_) return std::nullopt;
  for (Evaluation& trial : collected_) trial.index /= trials_;
  Result result{std::move(collected_.front()), {}, request_, hashes_, states_, 0};
  result.more.assign(std::make_move_iterator(collected_.begin() + 1), std::make_move_iterator(collected_.end()));
  collected_.clear();
  if (drives_) drives_->forget(result.evaluation.index);
  return result;
}

void Results::close() {
  if (!evaluator_) return;
  if (getpid() != process_) {  // its threads are not here, so it cannot be ended
    new std::shared_ptr<Evaluator>(std::move(evaluator_));
    return;
  }
  notes_ = evaluator_->notes();
  if (pulled_) pulled_->close();
  std::shared_ptr<Evaluator> evaluator = std::move(evaluator_);
  const ReleasedGil released;
  evaluator->stop();
  while (evaluator.use_count() > 1) std::this_thread::sleep_for(milliseconds(1));  // a thread is in next()
  evaluator.reset();
}

std::vector<std::string> Results::notes() const {
  return evaluator_ && getpid() == process_ ? evaluator_->notes() : notes_;
}

int visit_references(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  for (const nb::handle reference : nb::inst_ptr<Results>(self)->references()) Py_VISIT(reference.ptr());
  return 0;
}

int clear_references(PyObject* self) {
  if (!nb::inst_ready(self)) return 0;
  nb::inst_ptr<Results>(self)->close();
  nb::inst_ptr<Results>(self)->forget_references();
  return 0;
}

PyType_Slot results_slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(visit_references)},
                               {Py_tp_clear, reinterpret_cast<void*>(clear_references)},
                               {0, nullptr}};

constexpr double sample_period = 0.05;  // [s]

std::int64_t steps_in(double seconds, double dt, const char* name) {
  const double steps = seconds / dt;
  if (!(seconds >= 0) || !(steps < 9e15))
    throw InputError(name, std::string(nb::str(nb::handle(nb::cast(seconds))).c_str()) +
                               " is not accepted; give 0 s or more, and fewer than 9e15 steps");
  return std::llround(steps);
}

void race(EvaluationRequest& request, const std::vector<double>& checks, nb::handle goes_on,
          const TrialSettings& trials) {
  if (checks.empty() != goes_on.is_none()) throw InputError("checks", "go with goes_on; give both or neither");
  if (checks.empty()) return;
  if (trials.trials != 1) throw InputError("checks", "racing works with one trial per robot");
  for (const double time : checks) {
    const std::int64_t step = steps_in(time, request.configuration.dt, "checks");
    if (step <= (request.checks.empty() ? 0 : request.checks.back()) || step >= request.steps)
      throw InputError("checks", "give times in ascending order, after the start and before the end of the trial");
    request.checks.push_back(step);
  }
  const auto tried = std::make_shared<const EvaluationRequest>(request);
  request.goes_on = [called = CalledObject(goes_on), tried](const Evaluation& so_far) {
    return called.call([&](nb::handle function) {
      const nb::object answer = function(Result{so_far, {}, tried, false, false, 0});
      const int truth = PyObject_IsTrue(answer.ptr());
      if (truth < 0) throw nb::python_error();
      return truth == 1;
    });
  };
}

void drive(EvaluationRequest& request, std::shared_ptr<const Drives> drives, double period,
           const TrialSettings& trials) {
  request.drive_every = steps_in(period, request.configuration.dt, "drive_every");
  if (request.drive_every < 1) throw InputError("drive_every", "is less than a step; give at least dt");
  request.drive = [drives = std::move(drives), count = static_cast<std::size_t>(trials.trials)](
                      std::size_t index, const Robot& robot, std::int64_t number, std::span<float> values) {
    drives->write(index / count, robot, number, values);
  };
}

nb::object evaluate(nb::object source, double seconds, nb::handle environment, const std::string& solver, double dt,
                    double damping, nb::handle device, int threads, double settle, std::optional<double> sample_every,
                    int trials, std::optional<double> jitter, double target_radius, double target_spread,
                    bool target_sphere, bool turned, double delay, double noise, double damage, std::uint64_t seed,
                    nb::handle drives, double drive_every, const std::vector<double>& checks, nb::handle goes_on,
                    bool folding, bool upright, bool hashes, bool states, std::optional<std::size_t> memory_limit,
                    std::optional<std::size_t> portion) {
  const Configuration configuration = configuration_of(environment, solver, dt, damping, device, threads);
  validate(configuration);
  const std::int64_t steps = steps_in(seconds, dt, "seconds"), settling = steps_in(settle, dt, "settle");
  if (settling > steps) throw InputError("settle", "it is longer than seconds, which include it");
  const std::int64_t period = steps_in(sample_every.value_or(sample_period), dt, "sample_every");
  TrialSettings settings = one_trial();
  settings.seconds = seconds;
  settings.settle = settle;
  settings.trials = trials;
  settings.folding = folding;
  settings.upright = upright;
  settings.jitter = jitter.value_or(trials > 1 ? usual_jitter : 0);
  settings.target_radius = target_radius;
  settings.target_spread = target_spread;
  settings.target_sphere = target_sphere;
  settings.turned = turned;
  settings.delay = delay;
  settings.noise = noise;
  settings.damage = damage;
  check_parameters(settings);
  EvaluationRequest request = trial_request(settings, configuration, seed);
  request.settling = settling;
  request.steps = steps - settling;
  request.sample_every = std::max<std::int64_t>(1, period);
  request.hashes = hashes;
  request.states = states;
  request.memory_limit = memory_limit.value_or(0);
  request.portion = portion.value_or(0);
  race(request, checks, goes_on, settings);
  const std::shared_ptr<const Drives> signals = drives.is_none() ? nullptr : std::make_shared<const Drives>(drives);
  if (signals) drive(request, signals, drive_every, settings);
  nb::object results = nb::cast(std::make_unique<Results>(request, std::move(source), settings, seed, signals));
  nb::module_::import_("mercurysim._mercury").attr("_open_results").attr("add")(results);
  return results;
}

}  // namespace

void bind_evaluate(nb::module_& module) {
  bind_result(module);
  nb::class_<Results>(
      module, "Results", nb::type_slots(results_slots), nb::is_weak_referenceable(),
      "The iterator over Results that evaluate() returns. As a context manager it is closed at the end.")
      .def(
          "__iter__", [](nb::handle_t<Results> self) { return nb::borrow(self); },
          nb::sig("def __iter__(self) -> Results"))
      .def("__next__", &Results::next)
      .def(
          "__enter__", [](nb::handle_t<Results> self) { return nb::borrow(self); },
          nb::sig("def __enter__(self) -> Results"))
      .def(
          "__exit__", [](Results& self, const nb::args&) { self.close(); }, nb::arg("error"),
          nb::sig("def __exit__(self, *error: object) -> None"))
      .def("close", &Results::close, "Ends the evaluation: robots that are being stepped are given up.")
      .def_prop_ro("notes", &Results::notes,
                   "Lines worth reading so far, as that a robot is too large for the chip; usually none.")
      .def("__reduce_ex__",
           refused_pickle("the results of evaluate() cannot be pickled or copied: collect them in a list"),
           refused_pickle_signature);
  module.def(
      "evaluate", &evaluate, nb::arg("source").none(), nb::arg("seconds"), nb::kw_only(),
      nb::arg("environment") = nb::none(), nb::arg("solver") = "force", nb::arg("dt") = 1e-3, nb::arg("damping") = 0.1,
      nb::arg("device") = "auto", nb::arg("threads") = 0, nb::arg("settle") = 0.0, nb::arg("sample_every") = nb::none(),
      nb::arg("trials") = 1, nb::arg("jitter") = nb::none(), nb::arg("target_radius") = 0.0,
      nb::arg("target_spread") = 0.0, nb::arg("target_sphere") = false, nb::arg("turned") = false,
      nb::arg("delay") = 0.0, nb::arg("noise") = 0.0, nb::arg("damage") = 0.0, nb::arg("seed") = 1,
      nb::arg("drives") = nb::none(), nb::arg("drive_every") = 0.02, nb::arg("checks") = std::vector<double>(),
      nb::arg("goes_on") = nb::none(), nb::arg("folding") = false, nb::arg("upright") = false,
      nb::arg("hashes") = false, nb::arg("states") = false, nb::arg("memory_limit") = nb::none(),
      nb::arg("portion") = nb::none(),
      nb::sig("def evaluate(source: Robot | collections.abc.Iterable[Robot] | "
              "collections.abc.Callable[[int], Robot | None], seconds: float, *, "
              "environment: Environment | str | None = None, solver: str = 'force', dt: float = 0.001, "
              "damping: float = 0.1, device: object = 'auto', threads: int = 0, settle: float = 0.0, "
              "sample_every: float | None = None, trials: int = 1, jitter: float | None = None, "
              "target_radius: float = 0.0, target_spread: float = 0.0, target_sphere: bool = False, "
              "turned: bool = False, delay: float = 0.0, noise: float = 0.0, damage: float = 0.0, seed: int = 1, "
              "drives: numpy.typing.ArrayLike | collections.abc.Sequence[numpy.typing.ArrayLike] | "
              "collections.abc.Callable[[int, Robot], numpy.typing.ArrayLike] | None = None, "
              "drive_every: float = 0.02, checks: collections.abc.Sequence[float] = (), "
              "goes_on: collections.abc.Callable[[Result], bool] | None = None, "
              "folding: bool = False, upright: bool = False, hashes: bool = False, states: bool = False, "
              "memory_limit: int | None = None, portion: int | None = None) -> Results"),
      evaluate_description);
  // What is open when the interpreter exits is closed while threads can still run.
  const nb::object open = nb::module_::import_("weakref").attr("WeakSet")();
  module.attr("_open_results") = open;
  nb::module_::import_("atexit").attr("register")(nb::cpp_function([open] {
    for (const nb::handle results : nb::list(open)) nb::cast<Results&>(results).close();
  }));
}

}  // namespace mercury::python
