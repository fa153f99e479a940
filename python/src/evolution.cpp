// SPDX-License-Identifier: Apache-2.0
// The search that mercurysim/evolution.py is written with.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mercury/custom.h"
#include "mercury/error.h"
#include "mercury/evolution.h"
#include "mercury/fnv.h"
#include "mercury/run_folder.h"
#include "python/src/bindings.h"
#include "python/src/custom_parts.h"
#include "python/src/genomes.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

// What a program brings.
struct BroughtParts {
  nb::object kind, selection, scoring;  // of custom genomes, of an algorithm, of objectives; None = it brings none
};

// An evolution, in a run folder or in memory alone.
//
// A run that goes on may repeat the generations that it has: ask(), assess() and tell() then give and take what is in
// the journal, so a program that does the same as before, such as an optimizer with its seed, comes to where it was.
class Search {
 public:
  Search(const std::optional<std::filesystem::path>& folder, const GenomeSpaceRequest& space,
         const EvolutionSettings& settings, bool force, const BroughtParts& brought)
      : Search(brought) {
    settings_ = settings;
    if (folder)
      folder_.emplace(RunFolder::create(
          *folder, {.evolution = settings, .space = space, .program = "Mercury " MERCURY_VERSION}, force, make_space_));
    else
      space_ = make_space_(space);
    begin(brought);
  }
  // Goes on with a run, or repeats it from generation `repeat` on.
  Search(const std::filesystem::path& folder, std::optional<int> generations, const std::optional<Device>& device,
         std::optional<int> repeat, const BroughtParts& brought)
      : Search(brought) {
    folder_.emplace(RunFolder::open(folder, make_space_));
    if (generations) folder_->set_generations(*generations);
    settings_ = folder_->history().settings().evolution;
    if (device) settings_.configuration.device = *device;
    const auto recorded = static_cast<int>(folder_->history().generations().size());
    if (repeat && (*repeat < 0 || *repeat > recorded))
      throw InputError("repeat", std::to_string(*repeat) + " is not accepted; the run has " + std::to_string(recorded) +
                                     " generations");
    if (repeat && *repeat < recorded) repeated_ = *repeat;
    begin(brought);
    {
      const ReleasedGil released;
      restore(folder_->history(), *evolution_);
    }
    for (const Individual& individual : folder_->history().individuals()) line_began_.push_back(individual.line_began);
  }

  bool is_over() const { return !repeated_ && evolution_->is_over(); }
  int next_generation() const { return repeated_.value_or(evolution_->next_generation()); }
  bool needs_values() const { return algorithm_of(settings_.algorithm).of_behavior; }
  std::size_t objectives() const { return settings_.objectives.size(); }
  const std::vector<Individual>& living() const { return evolution_->living(); }
  const GenomeSpace& space() const { return folder_ ? folder_->space() : *space_; }

  // One generation; false if there was none to go. Ctrl-C ends it, and it is as if it had not begun.
  bool advance() {
    const Use use(*this);
    if (is_over()) return false;
    if (repeated_) return end_repeated(), true;
    require_children();
    std::optional<nb::python_error> interrupted;
    start_clock();
    {
      const ReleasedGil released;
      const auto generation = evolution_->advance(assessor(), watch(interrupted));
      if (generation) record(*generation);
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
    std::vector<SharedGenome> genomes;
    for (GenomePointer& genome : asked_genomes()) genomes.push_back({std::move(genome)});
    return genomes;
  }

  // Tries genomes, or those that are asked, as the settings say.
  Assessed assess(const std::optional<std::vector<nb::object>>& given) {
    const Use use(*this);
    Assessed assessed{.genomes = genomes_or_asked(given), .assessments = {}};
    if (repeated_) {
      require_same(assessed.genomes);
      for (const Individual& individual : recorded()) assessed.assessments.push_back(individual.assessment);
      return assessed;
    }
    std::optional<nb::python_error> interrupted;
    {
      const ReleasedGil released;
      auto assessments = assessor().assess(assessed.genomes, evolution_->interim_limits(), watch(interrupted));
      if (assessments) assessed.assessments = *std::move(assessments);
    }
    if (interrupted) throw nb::python_error(std::move(*interrupted));
    return assessed;
  }

  // What a program says of genomes, or of those that are asked. `scores`: [genome][objective], `values`:
  // [genome][quantity], or none at all; the fate of robots whose scores are not finite is `failed` unless `fates` says
  // another one.
  Assessed scored(const std::optional<std::vector<nb::object>>& given, const std::vector<std::vector<double>>& scores,
                  const std::vector<std::vector<double>>& values, const std::vector<std::string>& fates,
                  const std::vector<std::string>& problems, const std::vector<std::uint64_t>& hashes) {
    const Use use(*this);
    if (!given && !repeated_ && asked_.empty()) throw InputError("call ask() before tell()");
    Assessed assessed{.genomes = genomes_or_asked(given), .assessments = {}};
    if (scores.size() != assessed.genomes.size())
      throw InputError("scores", std::to_string(scores.size()) + " are not accepted; " +
                                     (given ? "there are " : "ask() gave ") + std::to_string(assessed.genomes.size()) +
                                     " genomes");
    for (std::size_t i = 0; i < scores.size(); ++i) {
      Assessment& assessment = assessed.assessments.emplace_back();
      const bool sound = std::ranges::all_of(scores[i], [](double score) { return std::isfinite(score); });
      assessment.fate = sound ? Fate::sound : fate_named(fates[i]).value_or(Fate::failed);
      assessment.scores = sound ? scores[i] : std::vector<double>(scores[i].size(), worst_score);
      assessment.violation = sound ? 0 : std::numeric_limits<double>::infinity();
      if (!sound) assessment.problem = problems[i];
      if (!values.empty() && assessment.fate != Fate::failed) assessment.values = values[i];
      if (!hashes.empty()) assessment.hash = hashes[i];
    }
    return assessed;
  }

  // Selects, and writes the generation. Children that were not asked for have these `parents`, by their ids.
  void tell(const Assessed& assessed, const std::optional<std::vector<std::vector<std::uint64_t>>>& parents,
            const std::optional<std::vector<std::uint64_t>>& living) {
    const Use use(*this);
    if (folder_ && is_over())
      throw InputError("the run has all its " + std::to_string(settings_.generations) +
                       " generations; evolution.resume(folder, generations=N) raises their number");
    if (repeated_) {
      require_same(assessed.genomes);
      require_same_scores(assessed);
      return end_repeated();
    }
    std::vector<Individual> born = born_of(assessed, parents);
    const ReleasedGil released;
    const Generation generation =
        living ? evolution_->select(std::move(born), *living) : evolution_->select(std::move(born));
    record(generation);
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
  using Clock = std::chrono::steady_clock;

  explicit Search(const BroughtParts& brought)
      : make_space_(space_maker(brought.kind)), has_selection_(!brought.selection.is_none()) {}

  void begin(const BroughtParts& brought) {
    std::unique_ptr<Algorithm> algorithm;
    if (has_selection_) algorithm = algorithm_of_python(settings_.algorithm, brought.selection);
    if (!brought.scoring.is_none()) assessor_ = scored_by_python(make_assessor(settings_), settings_, brought.scoring);
    const ReleasedGil released;
    evolution_.emplace(settings_, space(), std::move(algorithm));
  }

  // A device that is not there is noticed when it is needed.
  Assessor& assessor() {
    if (!assessor_) assessor_ = make_assessor(settings_);
    return *assessor_;
  }

  void require_children() const {
    if (is_custom(settings_.algorithm.name) && !has_selection_)
      throw InputError("algorithm", settings_.algorithm.name +
                                        " is a program, which makes the children itself; give them to assess() and "
                                        "tell(), or the algorithm to start() or resume()");
  }

  void start_clock() {
    if (!started_) started_ = Clock::now();
  }

  // Without the GIL.
  static Watch watch(std::optional<nb::python_error>& interrupted) {
    return [&interrupted](std::size_t, std::size_t) {
      const nb::gil_scoped_acquire acquired;
      if (!interrupted && PyErr_CheckSignals() != 0) interrupted.emplace();
      return !interrupted;
    };
  }

  void record(const Generation& generation) {
    asked_.clear();
    for (const Individual& individual : generation.born) line_began_.push_back(individual.line_began);
    const double seconds =
        started_ ? std::chrono::duration<double>(Clock::now() - *std::exchange(started_, std::nullopt)).count() : 0;
    if (folder_) folder_->append(generation, {.seconds = seconds, .device = assessor_ ? assessor_->device_name() : ""});
  }

  std::vector<GenomePointer> asked_genomes() {
    start_clock();
    std::vector<GenomePointer> genomes;
    if (repeated_) {
      for (const Individual& individual : recorded()) genomes.push_back(folder_->history().genome(individual.id));
      return genomes;
    }
    if (asked_.empty()) {
      require_children();
      const ReleasedGil released;
      asked_ = evolution_->children();
    }
    if (asked_.empty()) throw InputError("generation " + std::to_string(next_generation()), "no robot could be made");
    for (const Individual& child : asked_) genomes.push_back(child.genome);
    return genomes;
  }
  std::vector<GenomePointer> genomes_or_asked(const std::optional<std::vector<nb::object>>& given) {
    if (!given) return asked_genomes();
    start_clock();
    std::vector<GenomePointer> genomes;
    for (const nb::object& one : *given) genomes.push_back(genome_from(one, space()));
    if (genomes.empty()) throw InputError("genomes", "there is none; give at least one");
    return genomes;
  }

  // Those that are asked, or new ones.
  std::vector<Individual> born_of(const Assessed& assessed,
                                  const std::optional<std::vector<std::vector<std::uint64_t>>>& parents) const {
    std::vector<Individual> born = asked_;
    const bool are_asked = !asked_.empty() && std::ranges::equal(asked_, assessed.genomes, {}, &Individual::genome);
    if (are_asked && parents) throw InputError("parents", "are known of the genomes that ask() gave");
    if (!are_asked) born = born_elsewhere(assessed.genomes, parents);
    for (std::size_t i = 0; i < born.size(); ++i) born[i].assessment = assessed.assessments[i];
    return born;
  }
  std::vector<Individual> born_elsewhere(const std::vector<GenomePointer>& genomes,
                                         const std::optional<std::vector<std::vector<std::uint64_t>>>& parents) const {
    if (settings_.algorithm.islands > 1)
      throw InputError("islands", "have the genomes of ask() alone; start the run without islands");
    if (parents && parents->size() != genomes.size())
      throw InputError("parents", std::to_string(parents->size()) + " are not accepted; give those of " +
                                      std::to_string(genomes.size()) + " genomes");
    std::vector<Individual> born;
    for (const GenomePointer& genome : genomes) {
      Individual& child = born.emplace_back();
      child.id = evolution_->next_id() + born.size() - 1;
      child.generation = child.line_began = evolution_->next_generation();
      child.genome = genome;
      if (!parents) continue;
      child.parents = (*parents)[born.size() - 1];
      if (child.parents.size() > 2) throw InputError("parents", "a robot has more than two; give at most two");
      for (const std::uint64_t parent : child.parents) {
        if (parent >= line_began_.size())
          throw InputError("parents", "robot " + std::to_string(parent) + " is out of range, " +
                                          std::to_string(line_began_.size()) + " were born before");
        child.line_began = std::min(child.line_began, line_began_[parent]);
      }
    }
    return born;
  }

  // --- A run that is repeated

  // Those born in the generation.
  std::span<const Individual> recorded() const {
    const std::span<const Individual> all = folder_->history().individuals();
    const auto born = std::ranges::equal_range(all, *repeated_, {}, &Individual::generation);
    return all.subspan(static_cast<std::size_t>(born.begin() - all.begin()), born.size());
  }
  std::string place() const { return "generation " + std::to_string(*repeated_); }
  void require_same(const std::vector<GenomePointer>& genomes) const {
    const std::span<const Individual> born = recorded();
    if (genomes.size() != born.size())
      throw InputError(place(), std::to_string(genomes.size()) + " genomes, and the run has " +
                                    std::to_string(born.size()) + "; repeat what the program did before");
    for (std::size_t i = 0; i < born.size(); ++i)
      if (genomes[i]->identity() != folder_->history().genome(born[i].id)->identity())
        throw InputError(place(), "genome " + std::to_string(i) + " is not that of robot " +
                                      std::to_string(born[i].id) +
                                      "; repeat what the program did before, with its "
                                      "seed");
  }
  void require_same_scores(const Assessed& assessed) const {
    const std::span<const Individual> born = recorded();
    for (std::size_t i = 0; i < born.size(); ++i)
      if (assessed.assessments[i].scores != born[i].assessment.scores)
        throw InputError(place(), "the score of genome " + std::to_string(i) + " is not that of robot " +
                                      std::to_string(born[i].id) + "; repeat what the program did before");
  }
  void end_repeated() {
    started_.reset();
    if (++*repeated_ == evolution_->next_generation()) repeated_.reset();
  }

  const GenomeSpaceMaker make_space_;
  const bool has_selection_;
  EvolutionSettings settings_;
  std::optional<RunFolder> folder_;
  std::unique_ptr<GenomeSpace> space_;  // unless there is a folder
  std::optional<Evolution> evolution_;
  std::unique_ptr<Assessor> assessor_;
  std::vector<Individual> asked_;  // children of the next generation, once they were asked for
  std::vector<int> line_began_;    // of everyone, by id
  std::optional<int> repeated_;    // the next generation, of those that the run has
  std::optional<Clock::time_point> started_;
  bool used_ = false;
};

std::vector<std::pair<std::vector<double>, SharedGenome>> living_of(const Search& self) {
  std::vector<std::pair<std::vector<double>, SharedGenome>> living;
  for (const Individual& individual : self.living())
    living.emplace_back(individual.assessment.scores, SharedGenome{individual.genome});
  return living;
}

}  // namespace

void bind_evolution(nb::module_& module) {
  bind_genomes(module);
  bind_custom_parts(module);
  bind_run_history(module);
  module.def("_hash_of_trials", [](const std::vector<std::uint64_t>& hashes) {
    Fnv1a all;
    for (const std::uint64_t hash : hashes) all.add(hash);
    return all.value();
  });
  nb::class_<Search>(module, "_Search")
      .def(
          "__init__",
          [](Search* self, nb::handle folder, nb::handle robots, nb::handle parameters, const std::string& genes,
             bool force, const nb::dict& settings, nb::object selection, nb::object scoring) {
            std::optional<std::filesystem::path> path;
            if (!folder.is_none()) path = path_from("folder", folder);
            WantedSpace wanted = space_wanted(robots, parameters, genes);
            const EvolutionSettings read = settings_from(settings, wanted.request);
            new (self) Search(path, wanted.request, read, force, {wanted.kind, selection, scoring});
          },
          nb::arg("folder").none(), nb::arg("robots"), nb::arg("parameters").none(), nb::arg("genes"), nb::arg("force"),
          nb::arg("settings"), nb::arg("selection").none(), nb::arg("scoring").none())
      .def_static(
          "resume",
          [](nb::handle folder, std::optional<int> generations, nb::handle device, std::optional<int> repeat,
             nb::object kind, nb::object selection, nb::object scoring) {
            std::optional<Device> other;
            if (!device.is_none()) other = device_named(nb::str(device).c_str());
            return std::make_unique<Search>(path_from("folder", folder), generations, other, repeat,
                                            BroughtParts{kind, selection, scoring});
          },
          nb::arg("folder"), nb::arg("generations").none(), nb::arg("device").none(), nb::arg("repeat").none(),
          nb::arg("kind").none(), nb::arg("selection").none(), nb::arg("scoring").none())
      .def_prop_ro("is_over", &Search::is_over)
      .def_prop_ro("next_generation", &Search::next_generation)
      .def_prop_ro("needs_values", &Search::needs_values)
      .def_prop_ro("objectives", &Search::objectives)
      .def("living", &living_of)
      .def("advance", &Search::advance)
      .def("write_all", &Search::write_all)
      .def("ask", &Search::ask)
      .def("assess", &Search::assess, nb::arg("genomes").none())
      .def("scored", &Search::scored, nb::arg("genomes").none(), nb::arg("scores"), nb::arg("values"), nb::arg("fates"),
           nb::arg("problems"), nb::arg("hashes"))
      .def("tell", &Search::tell, nb::arg("assessed"), nb::arg("parents").none(), nb::arg("living").none());
}

}  // namespace mercury::python
