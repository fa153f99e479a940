// SPDX-License-Identifier: Apache-2.0
// What mercurysim/evolution.py is written with: genomes, searches, and the history of a run folder.
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mercury/environment.h"
#include "mercury/error.h"
#include "mercury/evolution.h"
#include "mercury/generator.h"
#include "mercury/objective.h"
#include "mercury/origin.h"
#include "mercury/quantity.h"
#include "mercury/real_body.h"
#include "mercury/run_folder.h"
#include "mercury/threads.h"
#include "python/src/arguments.h"
#include "python/src/bindings.h"
#include "python/src/gil.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

// --- Genomes

struct SharedGenome {
  GenomePointer genome;
};

SharedRobot robot_of(const SharedGenome& self, const std::string& name) {
  const ReleasedGil released;
  return {std::make_shared<const Robot>(self.genome->grow(name))};
}

nb::bytes encoded(const SharedGenome& self) {
  const std::string text = self.genome->encode();
  return nb::bytes(text.data(), text.size());
}

GenomeSpaceRequest space_request(nb::handle robots, nb::handle parameters, const std::string& genes) {
  GenomeSpaceRequest request;
  request.genes = genes_named(genes);
  if (!nb::isinstance<nb::str>(robots)) {
    for (const auto& robot : robots_of(robots)) request.founders.push_back(*robot);
    if (request.founders.empty()) throw InputError("robots", "there is none; give at least one, or the name of a kind");
    if (!parameters.is_none()) throw InputError("parameters", "go with a kind of robots, such as \"voxel\"");
    return request;
  }
  const std::string word = text_from("robots", robots);
  std::vector<std::string> words;
  const Generator* found = nullptr;
  for (const Generator& generator : generators()) {
    words.push_back(generator.kind);
    if (word == generator.word || word == generator.kind) found = &generator;
  }
  if (!found) {
    std::string all;
    for (const std::string& each : words) all += (all.empty() ? "" : ", ") + each;
    throw InputError("robots", "\"" + word + "\" is no kind of robots; there are " + all + suggestion(word, words));
  }
  request.kind = found->kind;
  if (!parameters.is_none())
    request.values = generator_values("parameters of " + found->kind, *found,
                                      nb::steal<nb::kwargs>(PyDict_Copy(nb::cast<nb::dict>(parameters).ptr())));
  return request;
}

struct Genomes {
  std::shared_ptr<const GenomeSpace> space;
};

// --- Settings

void set(const std::string& name, double& to, nb::handle value) { to = number_from(name, value); }
void set(const std::string& name, bool& to, nb::handle value) { to = bool_from(name, value); }
void set(const std::string& name, std::uint64_t& to, nb::handle value) { to = seed_from(name, value); }
void set(const std::string& name, int& to, nb::handle value) {
  to = static_cast<int>(whole_from(name, value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

// "masses:20:120:8", or (name, lowest, highest, cells), of which only the name is needed.
MapAxis axis_from(nb::handle given) {
  const std::string wanted = "a text such as \"masses:20:120:8\", or (name, lowest, highest, cells)";
  nb::object parts = nb::borrow(given);
  if (nb::isinstance<nb::str>(given)) parts = given.attr("split")(":");
  if (!nb::isinstance<nb::list>(parts) && !nb::isinstance<nb::tuple>(parts)) refuse_type("axes", wanted, given);
  const std::size_t count = nb::len(parts);
  if (count != 1 && count != 3 && count != 4) throw InputError("axes", "give " + wanted);
  MapAxis axis;
  axis.quantity = text_from("axes", parts[0]);
  const auto quantity = find_quantity(axis.quantity);
  if (!quantity)
    throw InputError("axes",
                     "\"" + axis.quantity + "\" is no quantity" + suggestion(axis.quantity, names_of_quantities()));
  axis.lowest = quantities()[*quantity].usual_lowest;
  axis.highest = quantities()[*quantity].usual_highest;
  const nb::object to_number = nb::borrow(nb::handle(reinterpret_cast<PyObject*>(&PyFloat_Type)));
  if (count > 1)
    axis.lowest = nb::cast<double>(to_number(parts[1])), axis.highest = nb::cast<double>(to_number(parts[2]));
  if (count > 3)
    axis.cells = nb::cast<int>(nb::borrow(nb::handle(reinterpret_cast<PyObject*>(&PyLong_Type)))(parts[3]));
  return axis;
}

std::vector<std::string> texts_from(const std::string& name, nb::handle given) {
  if (nb::isinstance<nb::str>(given)) return {text_from(name, given)};
  std::vector<std::string> texts;
  for (const nb::handle each : given) texts.push_back(text_from(name, each));
  return texts;
}

// The water, floor and so on for which the robots are made, as `mercury evolve` chooses them.
Configuration usual_configuration(const GenomeSpaceRequest& space) {
  const Physics physics = physics_of(space);
  std::string wanted =
      space.founders.empty() ? generator_named(space.kind).environment : environment_of(space.founders.front());
  if (!is_environment(wanted) || (physics == Physics::real && has_water(environment_named(wanted)))) wanted.clear();
  return default_configuration(physics, wanted);
}

// Takes all settings out of `given` that it knows; refuses those that are left.
EvolutionSettings settings_from(const nb::dict& given, GenomeSpaceRequest& space) {
  EvolutionSettings settings;
  settings.configuration = usual_configuration(space);
  AlgorithmSettings& algorithm = settings.algorithm;
  bool has_algorithm = false, has_trials = false, has_population = false;
  nb::object device = nb::str("auto");
  int threads = 0;
  std::vector<std::string> names{"objective", "algorithm", "axes",   "environment", "solver",
                                 "dt",        "damping",   "device", "threads"};
  const auto read_table = [&](auto& table, const std::string& name, nb::handle value) {
    bool found = false;
    for_each_parameter(table, [&](const auto& parameter, auto& member) {
      if (names.empty() || std::string(parameter.name) != name) return;
      set(name, member, value);
      found = true;
    });
    return found;
  };
  const auto collect = [&](auto& table) {
    for_each_parameter(table, [&](const auto& parameter, auto&) { names.emplace_back(parameter.name); });
  };
  collect(settings), collect(algorithm), collect(settings.trials);
  for (const auto [key, value] : given) {
    const std::string name = text_from("settings", key);
    if (name == "objective") {
      settings.objectives = texts_from(name, value);
    } else if (name == "algorithm") {
      algorithm.name = text_from(name, value);
      has_algorithm = true;
    } else if (name == "axes") {
      for (const nb::handle axis : value) algorithm.axes.push_back(axis_from(axis));
    } else if (name == "environment") {
      if (!value.is_none()) settings.configuration.environment = environment_of(value);
    } else if (name == "solver") {
      settings.configuration.solver = solver_named(text_from(name, value));
    } else if (name == "dt") {
      settings.configuration.dt = number_from(name, value);
    } else if (name == "damping") {
      settings.configuration.damping = number_from(name, value);
    } else if (name == "device") {
      device = nb::borrow(value);
    } else if (name == "threads") {
      set(name, threads, value);
    } else if (!read_table(settings, name, value) && !read_table(algorithm, name, value) &&
               !read_table(settings.trials, name, value)) {
      throw nb::type_error(("there is no setting " + name + suggestion(name, names)).c_str());
    }
    has_trials = has_trials || name == "trials";
    has_population = has_population || name == "population";
  }
  settings.configuration.device = device_named(nb::str(device).c_str());
  settings.configuration.device.threads = threads;
  require_possible_threads(settings.configuration.device);
  if (!has_algorithm)
    algorithm.name = !algorithm.axes.empty() ? "map-elites" : settings.objectives.size() > 1 ? "nsga2" : "afpo";
  if (algorithm_named(algorithm.name).of_behavior && algorithm.axes.empty())
    for (const char* usual : {"masses", "muscle_share"}) algorithm.axes.push_back(axis_from(nb::str(usual)));
  if (settings.trials.racing && !has_trials) settings.trials.trials = 1;
  validate(settings);
  for (const std::string& formula : settings.objectives)
    if (const std::string why = why_meaningless(Objective(formula), settings.configuration.environment); !why.empty())
      throw InputError("objective", "\"" + formula + "\": " + why + "; give another environment or objective");
  space.environment = name_of(settings.configuration.environment);
  const std::unique_ptr<GenomeSpace> genomes = make_genome_space(space);
  validate(settings, *genomes);
  if (!has_population) algorithm.population = usual_population(algorithm.name, *genomes, settings.seed);
  return settings;
}

// --- A search

// An evolution, in a run folder or in memory alone.
class Search {
 public:
  Search(const std::optional<std::filesystem::path>& folder, const GenomeSpaceRequest& space,
         const EvolutionSettings& settings, bool force)
      : settings_(settings) {
    if (folder) {
      folder_.emplace(RunFolder::create(
          *folder, {.evolution = settings, .space = space, .program = "Mercury " MERCURY_VERSION}, force));
      evolution_.emplace(settings_, folder_->space());
    } else {
      space_ = make_genome_space(space);
      evolution_.emplace(settings_, *space_);
    }
  }
  // Goes on with a run.
  Search(const std::filesystem::path& folder, std::optional<int> generations, const std::optional<Device>& device)
      : folder_(RunFolder::open(folder)) {
    if (generations) folder_->set_generations(*generations);
    settings_ = folder_->history().settings().evolution;
    if (device) settings_.configuration.device = *device;
    evolution_.emplace(settings_, folder_->space());
    restore(folder_->history(), *evolution_);
  }

  bool is_over() const { return evolution_->is_over(); }
  int next_generation() const { return evolution_->next_generation(); }
  bool needs_values() const { return algorithm_named(settings_.algorithm.name).of_behavior; }
  std::size_t objectives() const { return settings_.objectives.size(); }
  const std::vector<Individual>& living() const { return evolution_->living(); }

  // One generation; false if there was none to go. Ctrl-C ends it, and it is as if it had not begun.
  bool advance() {
    const Use use(*this);
    if (evolution_->is_over()) return false;
    if (!assessor_) assessor_ = make_assessor(settings_);
    std::optional<nb::python_error> interrupted;
    const auto start = std::chrono::steady_clock::now();
    {
      const ReleasedGil released;
      const auto generation = evolution_->advance(*assessor_, [&](std::size_t, std::size_t) {
        const nb::gil_scoped_acquire acquired;
        if (!interrupted && PyErr_CheckSignals() != 0) interrupted.emplace();
        return !interrupted;
      });
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (generation && folder_) folder_->append(*generation, {.seconds = seconds, .device = assessor_->device_name()});
    }
    if (interrupted) throw nb::python_error(std::move(*interrupted));
    return true;
  }
  // Writes the files that follow from the journal.
  void write_all() {
    const Use use(*this);
    const ReleasedGil released;
    if (folder_) folder_->write_all();
  }

  std::vector<SharedGenome> ask() {
    const Use use(*this);
    if (folder_) throw InputError("a run folder tries its robots itself, by its objective");
    if (asked_.empty()) {
      const ReleasedGil released;
      asked_ = evolution_->children();
    }
    std::vector<SharedGenome> genomes;
    for (const Individual& child : asked_) genomes.push_back({child.genome});
    return genomes;
  }
  // `scores`: [child][objective]; `values`: [child][quantity], or empty.
  void tell(const std::vector<std::vector<double>>& scores, const std::vector<std::vector<double>>& values) {
    const Use use(*this);
    if (asked_.empty()) throw InputError("call ask() before tell()");
    if (scores.size() != asked_.size())
      throw InputError("scores", std::to_string(scores.size()) + " are not accepted; ask() gave " +
                                     std::to_string(asked_.size()) + " genomes");
    for (std::size_t i = 0; i < asked_.size(); ++i) {
      Assessment& assessment = asked_[i].assessment = {};
      bool sound = true;
      for (const double score : scores[i]) sound = sound && std::isfinite(score);
      assessment.fate = sound ? Fate::sound : Fate::failed;
      assessment.scores = sound ? scores[i] : std::vector<double>(scores[i].size(), worst_score);
      assessment.violation = sound ? 0 : std::numeric_limits<double>::infinity();
      if (!values.empty()) assessment.values = values[i];
    }
    const ReleasedGil released;
    evolution_->select(std::exchange(asked_, {}));
  }

 private:
  // One thread of Python at a time.
  class Use {
   public:
    explicit Use(Search& search) : search_(search) {
      if (search_.used_) throw nb::value_error("another call has not returned yet");
      search_.used_ = true;
    }
    ~Use() { search_.used_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Search& search_;
  };

  EvolutionSettings settings_;
  std::optional<RunFolder> folder_;
  std::unique_ptr<GenomeSpace> space_;
  std::optional<Evolution> evolution_;
  std::unique_ptr<Assessor> assessor_;
  std::vector<Individual> asked_;
  bool used_ = false;
};

std::vector<std::pair<std::vector<double>, SharedGenome>> living_of(const Search& self) {
  std::vector<std::pair<std::vector<double>, SharedGenome>> living;
  for (const Individual& individual : self.living())
    living.emplace_back(individual.assessment.scores, SharedGenome{individual.genome});
  return living;
}

// --- A run folder

// The memory belongs to the array.
template <class T>
nb::object owned(std::vector<T> values, std::vector<std::size_t> shape = {}) {
  auto* const kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* memory) noexcept { delete static_cast<std::vector<T>*>(memory); });
  if (shape.empty()) shape = {kept->size()};
  static T none{};
  return nb::cast(nb::ndarray<nb::numpy, T>(kept->empty() ? &none : kept->data(), shape.size(), shape.data(), owner),
                  nb::rv_policy::reference);
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// One array per property, one element per individual.
nb::dict individuals_of(const RunHistory& self) {
  const auto all = self.individuals();
  const std::size_t count = all.size(), objectives = self.settings().evolution.objectives.size();
  nb::dict columns;
  const auto column = [&]<class T>(const char* name, T, const auto& value) {
    std::vector<T> values;
    values.reserve(count);
    for (const Individual& individual : all) values.push_back(static_cast<T>(value(individual)));
    columns[name] = owned(std::move(values));
  };
  using Integer = std::int64_t;
  const auto parent = [](std::size_t i) {
    return [i](const Individual& one) { return i < one.parents.size() ? static_cast<Integer>(one.parents[i]) : -1; };
  };
  column("id", Integer{}, [](const Individual& one) { return one.id; });
  column("parent", Integer{}, parent(0));
  column("other_parent", Integer{}, parent(1));
  column("generation", Integer{}, [](const Individual& one) { return one.generation; });
  column("died", Integer{}, [&](const Individual& one) { return self.died(one.id).value_or(-1); });
  column("line_began", Integer{}, [](const Individual& one) { return one.line_began; });
  if (self.settings().evolution.algorithm.islands > 1)
    column("island", Integer{}, [](const Individual& one) { return one.island; });
  nb::list fates;
  for (const Individual& individual : all) {
    const std::string_view fate = name_of(individual.assessment.fate);
    fates.append(nb::str(fate.data(), fate.size()));
  }
  columns["fate"] = nb::module_::import_("numpy").attr("array")(fates, nb::arg("dtype") = "U12");
  for (std::size_t i = 0; i < objectives; ++i)
    column(i == 0 ? "score" : ("score" + std::to_string(i + 1)).c_str(), double{}, [i](const Individual& one) {
      return i < one.assessment.scores.size() ? one.assessment.scores[i] : worst_score;
    });
  for (std::size_t i = 0; i < quantities().size(); ++i)
    column(std::string(quantities()[i].name).c_str(), double{}, [i](const Individual& one) {
      return i < one.assessment.values.size() ? one.assessment.values[i] : not_a_number;
    });
  return columns;
}

nb::dict generations_of(const RunHistory& self) {
  nb::dict columns;
  const auto column = [&]<class T>(const char* name, T, const auto& value) {
    std::vector<T> values;
    for (const GenerationSummary& generation : self.generations()) values.push_back(static_cast<T>(value(generation)));
    columns[name] = owned(std::move(values));
  };
  using Integer = std::int64_t;
  column("generation", Integer{}, [](const GenerationSummary& one) { return one.number; });
  column("born", Integer{}, [](const GenerationSummary& one) { return one.born; });
  column("living", Integer{}, [](const GenerationSummary& one) { return one.living; });
  column("best", Integer{}, [](const GenerationSummary& one) { return one.best; });
  const std::size_t objectives = self.settings().evolution.objectives.size();
  for (std::size_t i = 0; i < objectives; ++i) {
    const std::string number = i == 0 ? "" : std::to_string(i + 1);
    const auto spread = [&](const char* name, double ScoreSpread::*member) {
      column((name + number).c_str(), double{},
             [&](const GenerationSummary& one) { return i < one.scores.size() ? one.scores[i].*member : worst_score; });
    };
    column(("best_score" + number).c_str(), double{},
           [i](const GenerationSummary& one) { return i < one.best_scores.size() ? one.best_scores[i] : worst_score; });
    spread("lower_quartile", &ScoreSpread::lower_quartile);
    spread("median", &ScoreSpread::median);
    spread("upper_quartile", &ScoreSpread::upper_quartile);
    spread("highest", &ScoreSpread::highest);
  }
  column("exploded", Integer{}, [](const GenerationSummary& one) { return one.exploded; });
  column("overstretched", Integer{}, [](const GenerationSummary& one) { return one.overstretched; });
  column("too_small", Integer{}, [](const GenerationSummary& one) { return one.too_small; });
  column("undefined", Integer{}, [](const GenerationSummary& one) { return one.undefined; });
  column("stopped", Integer{}, [](const GenerationSummary& one) { return one.stopped; });
  column("failed", Integer{}, [](const GenerationSummary& one) { return one.failed; });
  column("lines", Integer{}, [](const GenerationSummary& one) { return one.lines; });
  if (algorithm_named(self.settings().evolution.algorithm.name).has_map) {
    column("cells", Integer{}, [](const GenerationSummary& one) { return one.scored; });
    column("coverage", double{}, [](const GenerationSummary& one) { return one.coverage; });
    column("qd_score", double{}, [](const GenerationSummary& one) { return one.score_sum; });
  }
  if (const std::size_t islands = self.settings().evolution.algorithm.islands; islands > 1)
    for (std::size_t i = 0; i < islands; ++i)
      column(("best_of_island_" + std::to_string(i)).c_str(), double{},
             [i](const GenerationSummary& one) { return one.best_of_islands[i]; });
  column("seconds", double{}, [](const GenerationSummary& one) { return one.times.seconds; });
  return columns;
}

nb::dict settings_of(const RunHistory& self) {
  const RunSettings& run = self.settings();
  const EvolutionSettings& evolution = run.evolution;
  nb::dict values;
  values["robots"] = run.space.founders.empty() ? run.space.kind : std::to_string(run.space.founders.size()) + " given";
  values["genes"] = name_of(run.space.genes);
  values["objective"] = nb::cast(evolution.objectives);
  values["algorithm"] = evolution.algorithm.name;
  nb::list axes;
  for (const MapAxis& axis : evolution.algorithm.axes)
    axes.append(nb::make_tuple(axis.quantity, axis.lowest, axis.highest, axis.cells));
  values["axes"] = axes;
  const auto add = [&](const auto& table) {
    for_each_parameter(table, [&](const auto& parameter, const auto& value) {
      values[std::string(parameter.name).c_str()] = nb::cast(value);
    });
  };
  add(evolution), add(evolution.algorithm), add(evolution.trials);
  values["environment"] = object_of(evolution.configuration.environment);
  values["solver"] = std::string(name_of(evolution.configuration.solver));
  values["dt"] = evolution.configuration.dt;
  values["damping"] = evolution.configuration.damping;
  values["program"] = run.program;
  return values;
}

std::uint64_t known_id(const RunHistory& self, nb::handle given) {
  const std::int64_t id = whole_from("id", given);
  if (id < 0 || static_cast<std::uint64_t>(id) >= self.individuals().size())
    throw std::out_of_range("robot " + std::to_string(id) + " is out of range, the run has " +
                            std::to_string(self.individuals().size()));
  return static_cast<std::uint64_t>(id);
}

void bind_genomes(nb::module_& module) {
  nb::class_<SharedGenome>(
      module, "Genome",
      "What evolution changes, and what a robot is grown from. It never changes; everything is the "
      "same, bit\nfor bit, on every machine.")
      .def("robot", &robot_of, nb::arg("name") = "", "The robot. Raises InputError if this genome has none.")
      .def(
          "mutate",
          [](const SharedGenome& self, double strength, nb::handle seed) {
            return SharedGenome{self.genome->mutate(strength, seed_from("seed", seed))};
          },
          nb::kw_only(), nb::arg("strength") = 1.0, nb::arg("seed"),
          nb::sig("def mutate(self, *, strength: float = 1.0, seed: int) -> Genome"),
          "A changed copy; a strength of 1 changes a little, as in a search.")
      .def(
          "cross",
          [](const SharedGenome& self, const SharedGenome& other, nb::handle seed) {
            return SharedGenome{self.genome->cross(*other.genome, seed_from("seed", seed))};
          },
          nb::arg("other"), nb::kw_only(), nb::arg("seed"),
          nb::sig("def cross(self, other: Genome, *, seed: int) -> Genome"),
          "A child of this genome and another one of the same Genomes.")
      .def("encode", &encoded, "The genome as bytes, which Genomes.decode() takes.")
      .def(
          "__eq__",
          [](const SharedGenome& self, nb::handle other) {
            SharedGenome second;
            return nb::try_cast(other, second) && second.genome->identity() == self.genome->identity();
          },
          nb::arg("other").none(), nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__hash__",
           [](const SharedGenome& self) { return static_cast<std::int64_t>(self.genome->identity() >> 2); });
  nb::class_<Genomes>(module, "Genomes",
                      R"(The genomes among which a search looks.

robots: a kind of robots ("voxel", "cppn", "nn", "shell", "tapered"), or Robots to begin with.
parameters: of that kind, as of mercurysim.random_voxel() and its like.
genes: what changes: "body", "muscles", "both", or these with "brain" ("muscles,brain").

Raises InputError for what cannot be used.)")
      .def(
          "__init__",
          [](Genomes* self, nb::handle robots, nb::handle parameters, const std::string& genes) {
            new (self) Genomes{make_genome_space(space_request(robots, parameters, genes))};
          },
          nb::arg("robots") = "voxel", nb::arg("parameters") = nb::none(), nb::kw_only(), nb::arg("genes") = "body",
          nb::sig("def __init__(self, robots: str | Robot | collections.abc.Iterable[Robot] = 'voxel', "
                  "parameters: dict[str, typing.Any] | None = None, *, genes: str = 'body') -> None"))
      .def(
          "random",
          [](const Genomes& self, nb::handle seed, nb::handle index) {
            return SharedGenome{self.space->random(seed_from("seed", seed), seed_from("index", index))};
          },
          nb::arg("seed") = 1, nb::arg("index") = 0,
          nb::sig("def random(self, seed: int = 1, index: int = 0) -> Genome"),
          "The index-th random genome of a seed. The first ones are those of the robots that were given.")
      .def(
          "decode",
          [](const Genomes& self, const nb::bytes& bytes) {
            return SharedGenome{self.space->decode({bytes.c_str(), bytes.size()})};
          },
          nb::arg("bytes"), "The reverse of Genome.encode(). Raises InputError for bytes that are no genome.");
}

}  // namespace

void bind_evolution(nb::module_& module) {
  bind_genomes(module);
  nb::class_<Search>(module, "_Search")
      .def(
          "__init__",
          [](Search* self, nb::handle folder, nb::handle robots, nb::handle parameters, const std::string& genes,
             bool force, const nb::dict& settings) {
            std::optional<std::filesystem::path> path;
            if (!folder.is_none()) path = path_from("folder", folder);
            GenomeSpaceRequest space = space_request(robots, parameters, genes);
            const EvolutionSettings read = settings_from(settings, space);
            new (self) Search(path, space, read, force);
          },
          nb::arg("folder").none(), nb::arg("robots"), nb::arg("parameters").none(), nb::arg("genes"), nb::arg("force"),
          nb::arg("settings"))
      .def_static(
          "resume",
          [](nb::handle folder, std::optional<int> generations, nb::handle device) {
            std::optional<Device> other;
            if (!device.is_none()) other = device_named(nb::str(device).c_str());
            return std::make_unique<Search>(path_from("folder", folder), generations, other);
          },
          nb::arg("folder"), nb::arg("generations").none(), nb::arg("device").none())
      .def_prop_ro("is_over", &Search::is_over)
      .def_prop_ro("next_generation", &Search::next_generation)
      .def_prop_ro("needs_values", &Search::needs_values)
      .def_prop_ro("objectives", &Search::objectives)
      .def("living", &living_of)
      .def("advance", &Search::advance)
      .def("write_all", &Search::write_all)
      .def("ask", &Search::ask)
      .def("tell", &Search::tell, nb::arg("scores"), nb::arg("values"));
  nb::class_<RunHistory>(module, "_History")
      .def(
          "__init__", [](RunHistory* self, nb::handle folder) { new (self) RunHistory(path_from("folder", folder)); },
          nb::arg("folder"))
      .def("refresh", &RunHistory::refresh)
      .def("individuals", &individuals_of)
      .def("generations", &generations_of)
      .def("settings", &settings_of)
      .def("__len__", [](const RunHistory& self) { return self.individuals().size(); })
      .def("robot",
           [](const RunHistory& self, nb::handle id) {
             return SharedRobot{std::make_shared<const Robot>(self.grow(known_id(self, id)))};
           })
      .def("genome",
           [](const RunHistory& self, nb::handle id) { return SharedGenome{self.genome(known_id(self, id))}; })
      .def("line_of", [](const RunHistory& self, nb::handle id) { return self.line_of(known_id(self, id)); })
      .def("living", [](const RunHistory& self) {
        return std::vector<std::uint64_t>(self.living().begin(), self.living().end());
      });
  module.def("_quantities", [] { return names_of_quantities(); });
}

}  // namespace mercury::python
