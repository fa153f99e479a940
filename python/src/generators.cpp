// SPDX-License-Identifier: Apache-2.0
// random_voxel() and its siblings. Signatures, docstrings and checks come from the registry of generators.
#include "mercury/generator.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <charconv>

#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "mercury/lively.h"
#include "mercury/names.h"
#include "python/src/bindings.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

// What a parameter's kind is called in a type hint.
struct TypeHint {
  const GeneratorParameter& parameter;
  std::string operator()(std::int64_t) const { return "int"; }
  std::string operator()(double) const { return "float"; }
  std::string operator()(const std::string&) const {
    std::string words;
    for (const std::string& word : parameter.words) words += (words.empty() ? "'" : ", '") + word + "'";
    return "typing.Literal[" + words + "]";
  }
  std::string operator()(const std::vector<int>&) const { return "collections.abc.Sequence[int]"; }
  std::string operator()(const SizeRange&) const {
    return "tuple[int, int, int] | tuple[tuple[int, int, int], tuple[int, int, int]]";
  }
};

// A value as Python writes it.
struct Source {
  std::string operator()(const std::string& word) const { return "'" + word + "'"; }
  std::string operator()(const std::vector<int>& numbers) const { return in_brackets(numbers, "[]"); }
  std::string operator()(const SizeRange& sizes) const {
    return "(" + in_brackets(sizes.smallest, "()") + ", " + in_brackets(sizes.largest, "()") + ")";
  }
  template <class Number>
  std::string operator()(Number number) const {
    char room[32];
    return {room, std::to_chars(room, room + sizeof room, number).ptr};
  }

 private:
  static std::string in_brackets(const auto& numbers, const char* brackets) {
    std::string text;
    for (const int number : numbers) text += (text.empty() ? "" : ", ") + std::to_string(number);
    return brackets[0] + text + brackets[1];
  }
};

constexpr std::uint64_t most_lively = 100'000;
constexpr const char* lively_name = "lively";

std::vector<nb::object> items_of(const std::string& name, const std::string& wanted, nb::handle value) {
  if (PyUnicode_Check(value.ptr()) || !nb::isinstance<nb::iterable>(value)) refuse_type(name, wanted, value);
  std::vector<nb::object> items;
  constexpr std::size_t most = 100;  // no parameter takes more; an iterator may have no end
  for (const nb::handle item : value) {
    items.push_back(nb::borrow(item));
    if (items.size() > most)
      throw InputError(name, "more than " + std::to_string(most) + " values are not accepted; give " + wanted);
  }
  return items;
}

int int_from(const std::string& name, nb::handle value) {
  return static_cast<int>(whole_from(name, value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

// Reads a value of the kind that the parameter's default has; ranges are checked by the registry.
struct Reader {
  const std::string& name;
  nb::handle value;

  ParameterValue operator()(std::int64_t) const { return whole_from(name, value); }
  ParameterValue operator()(float) const { return static_cast<float>(number_from(name, value)); }
  ParameterValue operator()(double) const { return number_from(name, value); }
  ParameterValue operator()(const std::string&) const { return text_from(name, value); }
  ParameterValue operator()(const std::vector<int>&) const {
    std::vector<int> numbers;
    for (const nb::object& item : items_of(name, "a sequence of whole numbers", value))
      numbers.push_back(int_from(name, item));
    return numbers;
  }
  ParameterValue operator()(const SizeRange&) const {
    const std::string wanted = "sizes (x, y, z), or a range ((x, y, z), (x, y, z))";
    const auto items = items_of(name, wanted, value);
    if (items.size() == 2) return SizeRange{size_from(wanted, items[0]), size_from(wanted, items[1])};
    const auto size = size_from(wanted, value);
    return SizeRange{size, size};
  }

 private:
  std::array<int, 3> size_from(const std::string& wanted, nb::handle given) const {
    const auto items = items_of(name, wanted, given);
    if (items.size() != 3)
      throw InputError(name, std::to_string(items.size()) + " sizes are not accepted; give " + wanted);
    return {int_from(name, items[0]), int_from(name, items[1]), int_from(name, items[2])};
  }
};

// Raises MemoryError if `count` robots like these do not fit into memory.
void require_memory_for(std::uint64_t count, const std::vector<Robot>& some) {
  double bytes = 0;
  for (const Robot& robot : some) bytes += MemoryUse{}.of(robot);
  const double needed = bytes / static_cast<double>(some.size()) * static_cast<double>(count);
  const std::size_t usable = usable_host_memory();
  if (needed <= static_cast<double>(usable)) return;
  PyErr_SetString(PyExc_MemoryError, memory_line(static_cast<std::size_t>(std::min(needed, 1e18)), usable).c_str());
  throw nb::python_error();
}

nb::list random_robots(const std::string& function, const Generator& generator, nb::handle count_given,
                       nb::handle seed_given, nb::handle first_given, const nb::kwargs& given) {
  // Made portion by portion, so that Ctrl-C ends a count that was too large.
  constexpr std::uint64_t portion = 256;
  const auto count = static_cast<std::uint64_t>(whole_from("count", count_given, 0));
  RandomRobots request{.kind = generator.kind,
                       .seed = seed_from("seed", seed_given),
                       .first = seed_from("first", first_given),
                       .values = generator_values(function, generator, given)};
  nb::list list;
  if (given.contains(lively_name)) {
    const nb::handle lively = given[lively_name];
    if (!PyBool_Check(lively.ptr())) refuse_type(lively_name, "True or False", lively);
    if (lively.is(nb::bool_(true))) {
      request.count = static_cast<std::size_t>(count);
      if (count > most_lively) throw InputError("count", "with lively, give at most " + std::to_string(most_lively));
      std::vector<Robot> robots;
      {
        const ReleasedGil released;
        for (const RandomRobots& one :
             lively_requests(request, lively_configuration(request), [](std::size_t, std::size_t) {
               const nb::gil_scoped_acquire acquired;
               if (PyErr_CheckSignals() != 0) throw nb::python_error();
               return true;
             }))
          for (Robot& robot : make_random_robots(one)) robots.push_back(std::move(robot));
      }
      for (Robot& robot : robots) list.append(SharedRobot{std::make_shared<const Robot>(std::move(robot))});
      return list;
    }
  }
  for (std::uint64_t done = 0; done < count; done += request.count, request.first += request.count) {
    request.count = static_cast<std::size_t>(std::min(portion, count - done));
    std::vector<Robot> robots;
    {
      const ReleasedGil released;
      robots = make_random_robots(request);
    }
    if (done == 0 && count > portion) require_memory_for(count, robots);
    for (Robot& robot : robots) list.append(SharedRobot{std::make_shared<const Robot>(std::move(robot))});
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
  return list;
}

std::string signature_of(const std::string& function, const Generator& generator) {
  std::string text = "def " + function + "(count: int = 1, seed: int = 1, first: int = 0, *, lively: bool = False";
  for (const GeneratorParameter& parameter : generator.parameters)
    text += ", " + parameter.name + ": " + std::visit(TypeHint{parameter}, parameter.initial) + " = " +
            std::visit(Source{}, parameter.initial);
  return text + ") -> list[Robot]";
}

std::string documentation_of(const Generator& generator) {
  std::string text = generator.help + ": `count` robots of a seed, from number `first` on, named \"" + generator.kind +
                     "-SEED-NUMBER\".\nThe same arguments give the same robots, bit for bit, on every machine." +
                     (generator.note.empty() ? "" : "\n" + generator.note) +
                     "\n\nlively: the `count` robots that get farthest of ten times as many in a quick trial, the "
                     "liveliest first\n";
  for (const GeneratorParameter& parameter : generator.parameters) {
    const bool is_list = std::holds_alternative<std::vector<int>>(parameter.initial);
    text += parameter.name + ": " + parameter.help + (parameter.unit.empty() ? "" : " [" + parameter.unit + "]") +
            " (default " + std::visit(Source{}, parameter.initial) + "; " +
            (is_list ? "at most " + std::to_string(parameter.most_numbers) + " numbers, each " : "") +
            accepted_values(parameter) + ")\n";
  }
  return text + "\nRaises InputError for values that cannot be used, or if there is no such robot.";
}

}  // namespace

ParameterValues generator_values(const std::string& function, const Generator& generator, const nb::kwargs& given) {
  ParameterValues values;
  for (const auto [key, value] : given) {
    const auto name = nb::cast<std::string>(key);
    if (name == lively_name) continue;
    const auto parameter = std::ranges::find(generator.parameters, name, &GeneratorParameter::name);
    if (parameter == generator.parameters.end()) {
      std::vector<std::string> names{"count", "seed", "first", lively_name};
      for (const GeneratorParameter& known : generator.parameters) names.push_back(known.name);
      throw nb::type_error((function + "() has no parameter " + name + suggestion(name, names)).c_str());
    }
    ParameterValue read = std::visit(Reader{name, value}, parameter->initial);
    check(*parameter, read);
    values.emplace(name, std::move(read));
  }
  return values;
}

void bind_generators(nb::module_& module) {
  for (const Generator& generator : generators()) {
    const std::string function = "random_" + generator.word;
    const std::string signature = signature_of(function, generator), documentation = documentation_of(generator);
    module.def(
        function.c_str(),
        [function, &generator](nb::handle count, nb::handle seed, nb::handle first, const nb::kwargs& values) {
          return random_robots(function, generator, count, seed, first, values);
        },
        nb::arg("count").none() = 1, nb::arg("seed").none() = 1, nb::arg("first").none() = 0, nb::arg("parameters"),
        nb::sig(signature.c_str()), documentation.c_str());
  }
}

}  // namespace mercury::python
