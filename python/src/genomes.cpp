// SPDX-License-Identifier: Apache-2.0
#include "python/src/genomes.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/names.h"
#include "mercury/real_body.h"
#include "python/src/bindings.h"
#include "python/src/called_object.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

SharedRobot robot_of(const SharedGenome& self, const std::string& name) {
  const ReleasedGil released;
  return {std::make_shared<const Robot>(self.genome->grow(name))};
}

nb::bytes encoded(const SharedGenome& self) {
  std::string text;
  {
    const ReleasedGil released;
    text = self.genome->encode();
  }
  return nb::bytes(text.data(), text.size());
}

nb::object data_of(const SharedGenome& self) {
  return nb::module_::import_("json").attr("loads")(custom_genes_of(*self.genome).text);
}

std::vector<double> numbers_of(const SharedGenome& self) {
  std::vector<double> numbers = self.genome->numbers();
  if (numbers.empty()) throw InputError("genome", "is no fixed list of numbers");
  return numbers;
}

SharedGenome with_numbers(const SharedGenome& self, const std::vector<double>& numbers) {
  const std::size_t wanted = numbers_of(self).size();
  if (numbers.size() != wanted)
    throw InputError("numbers", std::to_string(numbers.size()) + " are not accepted; give " + std::to_string(wanted));
  for (const double number : numbers)
    if (!std::isfinite(number)) throw InputError("numbers", "one is not finite");
  return {self.genome->with_numbers(numbers)};
}

// (text, robot or None, problem), as a genome kind of mercurysim/_custom.py gives it.
CustomGenes genes_from(nb::handle given) {
  CustomGenes genes{.text = nb::cast<std::string>(given[0]), .robot = {}, .problem = nb::cast<std::string>(given[2])};
  if (genes.problem.empty()) genes.robot = *nb::cast<SharedRobot>(given[1]).robot;
  return genes;
}

CustomOperators operators_of(nb::handle kind) {
  if (kind.is_none()) return {};
  const CalledObject called(kind);
  return {.random =
              [called](std::uint64_t seed, std::uint64_t index) {
                return called.call([&](nb::handle it) { return genes_from(it.attr("random")(seed, index)); });
              },
          .mutate =
              [called](const CustomGenes& genes, double strength, std::uint64_t seed) {
                return called.call(
                    [&](nb::handle it) { return genes_from(it.attr("mutate")(genes.text, strength, seed)); });
              },
          .cross =
              [called](const CustomGenes& genes, const CustomGenes& other, std::uint64_t seed) {
                return called.call(
                    [&](nb::handle it) { return genes_from(it.attr("cross")(genes.text, other.text, seed)); });
              }};
}

ParameterValues custom_values(nb::handle parameters) {
  ParameterValues values;
  if (parameters.is_none()) return values;
  for (const auto [key, value] : nb::cast<nb::dict>(parameters)) {
    const std::string name = text_from("parameters", key);
    if (name != "physics") throw nb::type_error(("custom genomes have no parameter " + name).c_str());
    values[name] = text_from(name, value);
  }
  real_material_in(values);
  return values;
}

}  // namespace

nb::object kind_of(nb::handle genome_class) {
  if (genome_class.is_none()) return nb::none();
  return nb::module_::import_("mercurysim._custom").attr("Kind")(genome_class);
}

WantedSpace space_wanted(nb::handle robots, nb::handle parameters, const std::string& genes) {
  WantedSpace wanted{.request = {}, .kind = nb::none()};
  GenomeSpaceRequest& request = wanted.request;
  request.genes = genes_named(genes);
  if (PyType_Check(robots.ptr())) {
    wanted.kind = kind_of(robots);
    request.kind = nb::cast<std::string>(wanted.kind.attr("name"));
    request.values = custom_values(parameters);
    return wanted;
  }
  if (!nb::isinstance<nb::str>(robots)) {
    for (const auto& robot : robots_of(robots)) request.founders.push_back(*robot);
    if (request.founders.empty()) throw InputError("robots", "there is none; give at least one, or the name of a kind");
    if (!parameters.is_none()) throw InputError("parameters", "go with a kind of robots, such as \"voxel\"");
    return wanted;
  }
  const std::string word = text_from("robots", robots);
  if (is_custom(word)) {
    check_custom_name("robots", word);
    request.kind = word;
    request.values = custom_values(parameters);
    return wanted;
  }
  std::vector<std::string> words;
  const Generator* found = nullptr;
  for (const Generator& generator : generators()) {
    words.push_back(generator.kind);
    if (word == generator.word || word == generator.kind) found = &generator;
  }
  if (!found)
    throw InputError("robots", "\"" + word + "\" is no kind of robots; there are " + mercury::list_of(words) +
                                   suggestion(word, words));
  request.kind = found->kind;
  if (!parameters.is_none())
    request.values = generator_values("parameters of " + found->kind, *found,
                                      nb::steal<nb::kwargs>(PyDict_Copy(nb::cast<nb::dict>(parameters).ptr())));
  return wanted;
}

GenomeSpaceMaker space_maker(nb::handle kind) {
  const CustomOperators operators = operators_of(kind);
  return [operators](const GenomeSpaceRequest& request) -> std::unique_ptr<GenomeSpace> {
    if (request.founders.empty() && is_custom(request.kind))
      return std::make_unique<CustomSpace>(request.kind, operators);
    return make_genome_space(request);
  };
}

GenomePointer genome_from(nb::handle given, const GenomeSpace& space) {
  if (SharedGenome genome; nb::try_cast(given, genome)) return genome.genome;
  const auto* custom = dynamic_cast<const CustomSpace*>(&space);
  SharedRobot robot;
  if (!nb::try_cast(given, robot)) refuse_type("genomes", custom ? "Genomes or Robots" : "Genomes", given);
  if (!custom)
    throw InputError("genomes",
                     "a Robot is not accepted, since the run has genomes; start it with \"python:NAME\" as "
                     "its robots, or give Genomes");
  return custom->genome({.text = "null", .robot = *robot.robot, .problem = ""});
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
      .def("numbers", &numbers_of, nb::sig("def numbers(self) -> list[float]"),
           "The genome as a list of numbers without bounds, in which 1 is about the step of a mutation: what CMA-ES "
           "searches.\nRaises InputError for a genome that is none: muscles of a robot, weights of its brain and "
           "tapered robots are.")
      .def("with_numbers", &with_numbers, nb::arg("numbers"),
           nb::sig("def with_numbers(self, numbers: collections.abc.Sequence[float]) -> Genome"),
           "The genome with other finite numbers, as many. Those that it has give this genome, up to rounding.")
      .def_prop_ro("data", &data_of, nb::sig("def data(self) -> typing.Any"),
                   "Of a genome kind of your own, what its to_json() gave. Raises InputError for others.")
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
  const std::string of_genomes = R"(The genomes among which a search looks.

robots: a kind of robots ()" + generator_kinds() +
                                 R"(), or Robots to begin with; a class of yours, whose
objects are genomes (docs/python.md), or "python:NAME" for genomes that are Robots themselves (of_robot()).
parameters: of that kind, as of mercurysim.random_voxel() and its like; of the last two, {"physics": "real"} or none.
genes: what changes: "body", "muscles", "both", or these with "brain" ("muscles,brain").

Raises InputError for what cannot be used.)";
  nb::class_<Genomes>(module, "Genomes", of_genomes.c_str())
      .def(
          "__init__",
          [](Genomes* self, nb::handle robots, nb::handle parameters, const std::string& genes) {
            const WantedSpace wanted = space_wanted(robots, parameters, genes);
            new (self) Genomes{space_maker(wanted.kind)(wanted.request)};
          },
          nb::arg("robots") = "voxel", nb::arg("parameters") = nb::none(), nb::kw_only(), nb::arg("genes") = "body",
          nb::sig("def __init__(self, robots: str | type | Robot | collections.abc.Iterable[Robot] = 'voxel', "
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
          "of_robot",
          [](const Genomes& self, const SharedRobot& robot) {
            return SharedGenome{genome_from(nb::cast(robot), *self.space)};
          },
          nb::arg("robot"), "A genome that is this robot. Raises InputError unless the genomes are those of a program.")
      .def(
          "decode",
          [](const Genomes& self, const nb::bytes& bytes) {
            return SharedGenome{self.space->decode({bytes.c_str(), bytes.size()})};
          },
          nb::arg("bytes"), "The reverse of Genome.encode(). Raises InputError for bytes that are no genome.");
}

}  // namespace mercury::python
