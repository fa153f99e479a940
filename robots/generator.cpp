// SPDX-License-Identifier: Apache-2.0
#include "mercury/generator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/names.h"
#include "mercury/number_text.h"
#include "mercury/origin.h"
#include "mercury/real_body.h"
#include "robots/carried_points.h"
#include "robots/make_all.h"

namespace mercury {

// All generators. Each is described beside its robots.
Generator voxel_generator();
Generator nn_generator();
Generator shell_generator();
Generator cppn_generator();
Generator tapered_generator();

namespace {

// The robot with the real body that another has, if it has one.
Robot with_body_of(const Robot& other, Robot robot) {
  const std::optional<RealMaterial> material = real_material_of(other);
  return material ? with_real_body(robot, *material) : std::move(robot);
}

// Shared by all generators.
const std::vector<GeneratorParameter>& real_body_parameters() {
  static const std::vector<GeneratorParameter> all = [] {
    std::vector<GeneratorParameter> made{{.name = "physics",
                                          .help = "Bodies as in the paper, or of a real material",
                                          .words = {"paper", "real"},
                                          .shared = true,
                                          .initial = std::string("paper")}};
    const RealMaterial usual;
    for_each_parameter(usual, [&](const auto& parameter, float value) {
      made.push_back({.name = std::string(parameter.name),
                      .help = "With --physics real: " + std::string(parameter.help),
                      .unit = std::string(parameter.unit),
                      .accepts = parameter.accepts,
                      .usual_highest = static_cast<double>(parameter.typical.high),
                      .advanced = true,
                      .shared = true,
                      .initial = value});
    });
    return made;
  }();
  return all;
}

// What holds for all of them: children name their parents, a robot that is grown again keeps its origin, real bodies
// stay real, and what was said of the masses is kept.
Generator with_records(Generator generator) {
  const std::vector<GeneratorParameter>& common = real_body_parameters();
  generator.parameters.insert(generator.parameters.end(), common.begin(), common.end());
  generator.validate = [validate = std::move(generator.validate)](const ParameterValues& values) {
    validate(values);
    real_material_in(values);
  };
  generator.make = [make = std::move(generator.make)](const ParameterValues& values, const std::string& environment,
                                                      std::uint64_t seed, std::uint64_t index) {
    const std::optional<RealMaterial> material = real_material_in(values);
    Robot robot = make(values, environment, seed, index);
    return material ? with_real_body(robot, *material) : robot;
  };
  generator.regrow = [regrow = std::move(generator.regrow)](const Robot& robot) {
    Robot again = with_body_of(robot, regrow(without_real_body(robot)));
    again.origin = robot.origin;
    carry_control(robot, again);
    carry_points(robot, again);
    return again;
  };
  generator.mutate = [mutate = std::move(generator.mutate)](const Robot& parent, const MutationRequest& request,
                                                            const std::string& name) {
    validate(request);
    Robot child = with_body_of(parent, mutate(without_real_body(parent), request, name));
    child.origin = with_ancestry(child.origin, {.parents = {parent.name},
                                                .mutation_seed = request.seed,
                                                .strength = request.strength,
                                                .muscles = request.muscles});
    carry_control(parent, child);
    carry_points(parent, child);
    return child;
  };
  if (generator.cross)
    generator.cross = [cross = std::move(generator.cross)](const Robot& a, const Robot& b, std::uint64_t seed,
                                                           const std::string& name) {
      Robot child = with_body_of(a, cross(without_real_body(a), without_real_body(b), seed, name));
      child.origin = with_ancestry(child.origin, {.parents = {a.name, b.name}, .crossover_seed = seed});
      carry_control(a, child);
      carry_points(a, child);
      return child;
    };
  return generator;
}

}  // namespace

const std::vector<Generator>& generators() {
  static const std::vector<Generator> all = [] {
    std::vector<Generator> made{voxel_generator(), nn_generator(), shell_generator(), cppn_generator(),
                                tapered_generator()};
    for (Generator& generator : made) generator = with_records(std::move(generator));
    return made;
  }();
  return all;
}

std::optional<RealMaterial> real_material_in(const ParameterValues& values) {
  for (const GeneratorParameter& parameter : real_body_parameters()) check(parameter, value_of(values, parameter));
  if (std::get<std::string>(value_of(values, real_body_parameters().front())) != "real") return std::nullopt;
  RealMaterial material;
  for_each_parameter(material, [&](const auto& parameter, float& value) {
    if (const auto given = values.find(parameter.name); given != values.end()) value = std::get<float>(given->second);
  });
  check_parameters(material);
  return material;
}

namespace {

// Refuses values out of a parameter's range.
class Check {
 public:
  explicit Check(const GeneratorParameter& parameter) : parameter_(parameter) {}

  void operator()(const std::string& word) const {
    if (std::ranges::find(parameter_.words, word) == parameter_.words.end()) refuse("\"" + word + "\"");
  }
  void operator()(const std::vector<int>& numbers) const {
    if (numbers.size() > parameter_.most_numbers)
      throw ParameterError(parameter_.name, std::to_string(numbers.size()) +
                                                " numbers are not accepted; give at most " +
                                                std::to_string(parameter_.most_numbers));
    for (const int number : numbers) (*this)(number);
  }
  void operator()(const SizeRange& sizes) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      (*this)(sizes.smallest[axis]);
      (*this)(sizes.largest[axis]);
      if (sizes.smallest[axis] > sizes.largest[axis])
        throw ParameterError(parameter_.name, std::to_string(sizes.smallest[axis]) + " to " +
                                                  std::to_string(sizes.largest[axis]) +
                                                  " is not accepted; the first size must not be above the second");
    }
  }
  template <class Value>
  requires std::is_arithmetic_v<Value>
  void operator()(Value value) const {
    const auto number = static_cast<double>(value);
    // Options keep whole numbers as int.
    const bool too_large = std::is_integral_v<Value> && number > std::numeric_limits<int>::max();
    if (too_large || !parameter_.accepts(number)) refuse(shortest_text(value));
  }

 private:
  [[noreturn]] void refuse(const std::string& given) const {
    throw ParameterError(parameter_.name, given + " is not accepted; give " + accepted_values(parameter_));
  }
  const GeneratorParameter& parameter_;
};

}  // namespace

void check(const GeneratorParameter& parameter, const ParameterValue& value) {
  if (value.index() != parameter.initial.index())
    throw ParameterError(parameter.name, "another kind of value is expected; give " + accepted_values(parameter));
  std::visit(Check(parameter), value);
}

std::string accepted_values(const GeneratorParameter& parameter) {
  if (!parameter.words.empty()) return list_of(parameter.words, " or ");
  const bool is_real =
      std::holds_alternative<float>(parameter.initial) || std::holds_alternative<double>(parameter.initial);
  return parameter.accepts.text(!is_real) + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

const Generator* find_generator(std::string_view kind) {
  const auto found = std::ranges::find(generators(), kind, &Generator::kind);
  return found == generators().end() ? nullptr : &*found;
}

const Generator* generator_of(const Robot& robot) { return find_generator(kind_of(robot)); }

const Generator& generator_named(std::string_view kind) {
  if (const Generator* generator = find_generator(kind)) return *generator;
  throw ParameterError("kind", "\"" + std::string(kind) + "\" is not a kind of robot; give " + generator_kinds());
}

std::string generator_kinds(std::string_view after) {
  std::vector<std::string> kinds;
  for (const Generator& generator : generators()) kinds.push_back(generator.kind + std::string(after));
  return list_of(kinds, " or ");
}

const ParameterValue& value_of(const ParameterValues& values, const GeneratorParameter& parameter) {
  const auto found = values.find(parameter.name);
  return found == values.end() ? parameter.initial : found->second;
}

std::vector<Robot> make_random_robots(const RandomRobots& request, std::vector<FailedRobot>* failed,
                                      const WorkWatch& watch) {
  const Generator& generator = generator_named(request.kind);
  generator.validate(request.values);
  return make_all(
      request.kind, request.seed, request.count, request.first,
      [&](std::uint64_t index) { return generator.make(request.values, request.environment, request.seed, index); },
      failed, watch);
}

void validate(const MutationRequest& request) {
  for (const auto& [name, strength] : {std::pair("strength", request.strength), std::pair("muscles", request.muscles)})
    if (!(std::isfinite(strength) && strength >= 0))
      throw ParameterError(name, shortest_text(strength) + " is not accepted; give 0 or more");
}

// A robot as messages name it.
static std::string shown_name(const Robot& robot) { return robot.name.empty() ? "a robot without a name" : robot.name; }

static bool has_muscles(const Robot& robot) {
  const std::span<const Material> materials = materials_of(robot);
  return std::ranges::any_of(robot.springs,
                             [&](const Spring& spring) { return materials[spring.material].amplitude != 0; });
}

Robot mutate_robot(const Robot& parent, const MutationRequest& request, const std::string& name) {
  const Generator* generator = generator_of(parent);
  if (generator) return generator->mutate(parent, request, name);
  validate(request);
  if (request.muscles == 0)
    throw InputError(shown_name(parent), "cannot be mutated; only " + generator_kinds() +
                                             " robots know how they were made, but --muscles 1 changes its muscles");
  if (!has_muscles(parent)) throw InputError(shown_name(parent), "cannot be mutated; it has no muscles");
  Robot child = with_mutated_muscles(parent, request.muscles, request.seed);
  child.name = name;
  child.origin = with_ancestry(child.origin,
                               {.parents = {parent.name}, .mutation_seed = request.seed, .muscles = request.muscles});
  return child;
}

Robot cross_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name) {
  const Generator *generator = generator_of(a), *other = generator_of(b);
  for (const auto& [robot, its_own] : {std::pair(&a, generator), std::pair(&b, other)})
    if (!its_own)
      throw InputError(shown_name(*robot),
                       "cannot be crossed; only " + generator_kinds() + " robots know how they were made");
  if (generator != other)
    throw InputError(shown_name(a) + " and " + shown_name(b),
                     "cannot be crossed, " + generator->noun + " and " + other->noun + "; give two robots of one kind");
  if (!generator->cross) throw InputError(shown_name(a), "cannot be crossed, " + generator->noun + " has no crossover");
  return generator->cross(a, b, seed, name);
}

}  // namespace mercury
