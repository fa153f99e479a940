// SPDX-License-Identifier: Apache-2.0
// The registry of robot generators: ways to make random robots, each described once, as data.
//
// Programs derive from the descriptions whatever they offer: options of the command line, keys of a TOML file, help,
// controls of a window, checks of what the user gave. They name no generator. To add a generator:
//
//   robots/include/mercury/NAME.h  its plain struct of options, and functions for C++ users
//   robots/NAME.cpp                the robots, and `Generator NAME_generator()`, its description
//   robots/generator.cpp           one line in the list of all generators
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "mercury/parameters.h"
#include "mercury/robot.h"
#include "mercury/work_watch.h"

namespace mercury {

// Sizes along x, y and z, drawn for each robot between the two, both included.
struct SizeRange {
  std::array<int, 3> smallest{}, largest{};
  friend bool operator==(const SizeRange&, const SizeRange&) = default;
};

// A whole number; a number (in single precision where the robot keeps it so); one of several words; a list of whole
// numbers; sizes.
using ParameterValue = std::variant<std::int64_t, float, double, std::string, std::vector<int>, SizeRange>;

// Values by the name of their parameter, possibly of several generators. A parameter that is missing has its default.
using ParameterValues = std::map<std::string, ParameterValue, std::less<>>;

// What can be set of a generator.
struct GeneratorParameter {
  std::string name;       // in lower case with underscores, different from those of all other generators
  std::string help;       // what it is, in some words without a full stop
  std::string unit = {};  // "m", "voxels"; empty for a number without a unit
  Accepts accepts = Accepts::at_least_zero;  // for a list or sizes, of each number
  std::size_t most_numbers = 0;              // of a list
  std::vector<std::string> words{};          // of a word
  std::optional<double> usual_highest{};     // end of a slider, where that is below the highest that is accepted
  bool advanced = false;                     // a window shows it on demand only
  bool shared = false;                       // all generators have it
  ParameterValue initial{};                  // the default; also says which kind of value it is
};

// Throws ParameterError(name, "7 is not accepted; give 1 to 5") unless the value is of the parameter's kind and in its
// range.
void check(const GeneratorParameter& parameter, const ParameterValue& value);

// What to accept, for messages: "1 to 5", "0 m or more", "at least 0 and below 1", "none, x, y or z".
std::string accepted_values(const GeneratorParameter& parameter);

// How a mutant differs from its parent: 1 = a little, as in a search; 0 = not at all.
struct MutationRequest {
  double strength = 1;  // of changes of the body
  std::uint64_t seed = 1;
  double muscles = 0;  // of changes of the muscle laws (muscle_laws.h); a shell's numbers say both
};

// Throws ParameterError("strength", ...) unless both strengths are finite and at least 0.
void validate(const MutationRequest& request);

// What may change in a robot: a set.
enum class Genes : std::uint8_t {
  body = 1,     // the form and where which material is
  muscles = 2,  // amplitude, frequency and phase of each base muscle
  both = body | muscles,
  brain = 4  // the weights of its brain
};
constexpr Genes operator|(Genes a, Genes b) {
  return static_cast<Genes>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
constexpr Genes operator&(Genes a, Genes b) {
  return static_cast<Genes>(static_cast<std::uint8_t>(a) & static_cast<std::uint8_t>(b));
}
// Whether any of `some` is in the set.
constexpr bool contains(Genes set, Genes some) { return (set & some) != Genes{}; }

std::vector<Genes> all_gene_sets();        // but the empty one
std::string name_of(Genes genes);          // "body", "both", "muscles,brain", "body,muscles,brain"
Genes genes_named(std::string_view name);  // words in any order, "both" among them; throws ParameterError("genes", ...)

struct GenesKind;  // robots/genes.h

struct Generator {
  std::string kind;          // "voxel": names the generator in programs, and in the "kind" of its robots' origins
  std::string word;          // "painted": in names of functions, random_painted() of Python
  std::string title;         // "Voxel robots", the heading above its parameters
  std::string noun;          // "a voxel robot"
  std::string help;          // "Random voxel robots", in some words
  std::string note;          // further sentences for help texts; may be empty
  std::string environment;   // where its robots belong: "ocean", "ocean-simple", "land"; empty = anywhere
  bool smooth = false;       // the skin stands for a curved surface, to be shaded smoothly
  bool may_be_tiny = false;  // some of its robots are a few springs, so that searches ask for more masses
  std::vector<GeneratorParameter> parameters;
  // A robot worth trying, for help texts: its name, seed, and values as a user writes them.
  struct Example {
    std::string name;
    std::uint64_t seed = 1;
    std::vector<std::pair<std::string, std::string>> values;
  } example;

  // Throws ParameterError for values of its parameters that cannot be used, alone or together. Ignores other names.
  std::function<void(const ParameterValues& values)> validate;
  // The index-th robot of a seed, named "KIND-SEED-INDEX". It depends on the arguments alone, bit for bit on every
  // machine. Its origin has its kind, the environment (the generator's own if that is empty), and what regrow() and
  // mutate() need. With "physics" = "real" among the values it has a real body (real_body.h). Throws InputError if the
  // values cannot be used, or if there is no such robot.
  std::function<Robot(const ParameterValues& values, const std::string& environment, std::uint64_t seed,
                      std::uint64_t index)>
      make;
  // The three functions below keep the actuators of the robot (of `a`) if the table of materials stays the same except
  // for the muscle laws; otherwise the new robot names none.
  //
  // A robot of this generator once more from its origin (which it keeps, with what nobody knows in it) and its own
  // materials, bit for bit. Throws InputError("/origin/...") if the origin does not hold one.
  std::function<Robot(const Robot& robot)> regrow;
  // A changed copy, named `name`. Depends on the arguments alone, bit for bit on every machine. Throws InputError as
  // regrow and make, and for a request that validate() refuses. Its origin names the parent (origin.h).
  std::function<Robot(const Robot& parent, const MutationRequest& request, const std::string& name)> mutate;
  // A child of two robots of this generator, named `name`; body and muscle laws are mixed. It is a's where the parents
  // cannot be mixed: sizes, environment, a table without base materials. Depends on the arguments alone. Throws
  // InputError as regrow and make, and for parents that are too different. Its origin names both.
  std::function<Robot(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name)> cross;
  // Eight corners of each cell, x fastest, then y, then z, of a robot made of hexahedra that are no cubes; none
  // otherwise. A real body of it has springs and masses by their sizes.
  std::function<std::vector<std::array<std::uint16_t, 8>>(const Robot& robot)> cells;
  const GenesKind* genes = nullptr;  // what evolution changes; nullptr = these robots cannot be evolved
};

// All generators; the first one is the default.
const std::vector<Generator>& generators();

// The generator of that kind; nullptr if there is none.
const Generator* find_generator(std::string_view kind);
// The generator that made the robot, by its origin; nullptr if none of these did.
const Generator* generator_of(const Robot& robot);
// Throws ParameterError("kind", "\"fish\" is not a kind of robot; give voxel or nn").
const Generator& generator_named(std::string_view kind);

// "voxel, nn or shell": all kinds, with something after each, as in "voxel:N or nn:N".
std::string generator_kinds(std::string_view after = {});

// The parameter's value, its default if it is missing.
const ParameterValue& value_of(const ParameterValues& values, const GeneratorParameter& parameter);

// Random robots to be made: robots first .. first + count - 1 of a seed.
struct RandomRobots {
  std::string kind = "voxel";  // of a generator
  std::size_t count = 1;
  std::uint64_t seed = 1, first = 0;
  ParameterValues values{};
  std::string environment{};  // for their origins; empty = none is named
};

// A robot that could not be made, and why.
struct FailedRobot {
  std::uint64_t index = 0;
  std::string reason;
};

// The robots, in order, made on all cores. A robot that cannot be made is left out and listed in `failed`; without
// `failed`, the first such error is thrown. Throws ParameterError for an unknown kind or values that cannot be used.
// The watch sees how many are made.
std::vector<Robot> make_random_robots(const RandomRobots& request, std::vector<FailedRobot>* failed = nullptr,
                                      const WorkWatch& watch = {});

// A changed copy of a robot, named `name`. Of a robot that no generator made, only the muscles change, as in an
// evolution of muscles (with_mutated_muscles()); `strength` has no effect. Throws InputError if nothing of it could
// change.
Robot mutate_robot(const Robot& parent, const MutationRequest& request, const std::string& name);

// A child of two robots that one generator made, named `name`. Throws InputError if none did, or two different ones.
Robot cross_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name);

}  // namespace mercury
