// SPDX-License-Identifier: Apache-2.0
// Formulas are parsed by muParser. Its messages do not know our names, so names are checked before it sees a formula.
#include "mercury/objective.h"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>

#include "mercury/custom.h"
#include "mercury/error.h"
#include "mercury/individual.h"
#include "mercury/names.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

constexpr std::size_t longest_formula = 1000;  // characters
constexpr std::string_view operators = " .,+-*/^()<>=!&|?:";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool continues_name(char c) { return begins_name(c) || is_digit(c); }

[[noreturn]] void refuse(const std::string& formula, const std::string& problem) {
  constexpr std::size_t shown = 80;
  const std::string quoted = formula.size() <= shown ? formula : formula.substr(0, shown) + "...";
  throw ParameterError("objective", "\"" + quoted + "\": " + problem);
}

void check_characters(const std::string& formula) {
  if (formula.size() > longest_formula)
    refuse(formula, std::to_string(formula.size()) + " characters; give at most " + std::to_string(longest_formula));
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (continues_name(formula[i]) || operators.find(formula[i]) != std::string_view::npos) continue;
    const bool printable = formula[i] > ' ' && formula[i] <= '~';
    throw ParameterError("objective", "character " + std::to_string(i + 1) +
                                          (printable ? std::string(", ") + formula[i] + "," : std::string()) +
                                          " does not belong into a formula; give letters, digits and" +
                                          std::string(operators));
  }
}

// muParser takes = for an assignment.
void check_comparisons(const std::string& formula) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] != '=') continue;
    const char before = i > 0 ? formula[i - 1] : ' ';
    if (before == '<' || before == '>' || before == '!') continue;
    if (i + 1 < formula.size() && formula[i + 1] == '=') {
      ++i;
      continue;
    }
    refuse(formula, "= at character " + std::to_string(i + 1) + " sets a value; to compare, write ==");
  }
}

// End of the number that begins at i: "12", "0.5", "1e-3".
std::size_t end_of_number(const std::string& formula, std::size_t i) {
  const auto skip_digits = [&] {
    while (i < formula.size() && is_digit(formula[i])) ++i;
  };
  skip_digits();
  if (i < formula.size() && formula[i] == '.') ++i;
  skip_digits();
  if (i < formula.size() && (formula[i] == 'e' || formula[i] == 'E')) {
    std::size_t exponent = i + 1;
    if (exponent < formula.size() && (formula[exponent] == '-' || formula[exponent] == '+')) ++exponent;
    if (exponent < formula.size() && is_digit(formula[exponent])) {
      i = exponent;
      skip_digits();
    }
  }
  return i;
}

[[noreturn]] void refuse_name(const std::string& formula, const std::string& name, const char* noun,
                              const std::vector<std::string>& names) {
  const std::string nearest = suggestion(name, names);
  refuse(formula, "there is no " + std::string(noun) + " " + name +
                      (nearest.empty() ? "; give one of " + list_of(names) : nearest));
}

void check_names(const std::string& formula, const mu::Parser& parser) {
  for (std::size_t i = 0; i < formula.size();) {
    if (is_digit(formula[i]) || formula[i] == '.') {
      i = end_of_number(formula, i);
    } else if (begins_name(formula[i])) {
      const auto end = static_cast<std::size_t>(
          std::find_if_not(formula.begin() + static_cast<std::ptrdiff_t>(i), formula.end(), continues_name) -
          formula.begin());
      const std::string name = formula.substr(i, end - i);
      const std::size_t next = formula.find_first_not_of(' ', end);
      i = end;
      if (next != std::string::npos && formula[next] == '(') {
        std::vector<std::string> functions;
        for (const auto& [function, callback] : parser.GetFunDef()) functions.push_back(function);
        if (!parser.GetFunDef().contains(name)) refuse_name(formula, name, "function", functions);
      } else if (!find_quantity(name) && !parser.GetConst().contains(name)) {
        refuse_name(formula, name, "quantity", names_of_quantities());
      }
    } else {
      ++i;
    }
  }
}

// muParser's message without its capital letter and full stop, and with a place that is counted from 1.
std::string message_of(const mu::ParserError& error, const std::string& formula) {
  std::string message = error.GetMsg();
  if (!message.empty() && message.back() == '.') message.pop_back();
  if (!message.empty() && message[0] >= 'A' && message[0] <= 'Z')
    message[0] = static_cast<char>(message[0] - 'A' + 'a');
  for (const char* place : {" found at position", " at expression position", " at position"})
    if (const std::size_t cut = message.rfind(place); cut != std::string::npos) {
      message.erase(cut);
      if (const std::size_t at = error.GetPos(); at < formula.size())
        message += " at character " + std::to_string(at + 1);
    }
  return message;
}

}  // namespace

// A parser evaluates on a stack of its own, one thread at a time.
struct Objective::Parsed {
  explicit Parsed(const std::string& formula) : variables(quantities().size()) {
    check_characters(formula);
    check_comparisons(formula);
    try {
      check_names(formula, parser);
      for (std::size_t q = 0; q < variables.size(); ++q)
        parser.DefineVar(std::string(quantities()[q].name), &variables[q]);
      parser.SetExpr(formula);
      parser.Eval();  // parses
      for (const auto& [name, variable] : parser.GetUsedVar()) used.push_back(find_quantity(name).value());
      std::ranges::sort(used);
      if (parser.GetNumResults() != 1) refuse(formula, "is several formulas; give one, or several objectives");
    } catch (const mu::ParserError& error) {
      refuse(formula, message_of(error, formula));
    }
  }

  mutable std::mutex mutex;
  mutable std::vector<double> variables;
  std::vector<std::size_t> used;
  mutable mu::Parser parser;
};

Objective::Objective(const std::string& formula)
    : formula_(formula), parsed_(mercury::is_custom(formula) ? nullptr : std::make_shared<const Parsed>(formula)) {
  if (is_custom()) check_custom_name("objective", formula);
}

const std::vector<std::size_t>& Objective::uses() const {
  static const std::vector<std::size_t> none;
  return parsed_ ? parsed_->used : none;
}

std::string Objective::undefined_text() const { return "the objective \"" + formula_ + "\" is not a finite number"; }

bool uses_folding(const Objective& objective) {
  return std::ranges::any_of(objective.uses(), [](std::size_t q) { return quantities()[q].of_folding; });
}

bool uses_upright(const Objective& objective) {
  return std::ranges::any_of(objective.uses(), [](std::size_t q) { return quantities()[q].of_upright; });
}

// In water that drags each mass in proportion to its velocity, the mean force on a body is proportional to its own mean
// velocity, so it stays, or drifts with the flow, whatever its muscles do. Without water and ground, no force acts.
std::string why_meaningless(const Objective& objective, const Environment& environment) {
  const bool has_simple_drag = std::holds_alternative<PointDrag>(environment.water);
  if (has_ground(environment) || !(has_simple_drag || std::holds_alternative<NoWater>(environment.water))) return "";
  const auto travels = [](std::size_t q) { return quantities()[q].of_travel; };
  const auto found = std::ranges::find_if(objective.uses(), travels);
  if (found == objective.uses().end()) return "";
  return "no robot can move itself in " + std::string(name_of(environment)) +
         (has_simple_drag ? ": the drag of each mass is proportional to its velocity, so the mean force on a body is "
                            "proportional to its own mean velocity"
                          : ": there is nothing to push against") +
         "; " + std::string(quantities()[*found].name) + " would be rounding";
}

double Objective::score(std::span<const double> values) const {
  if (is_custom()) throw std::logic_error("a program scores robots by " + formula_);
  if (values.size() != parsed_->variables.size()) throw std::invalid_argument("an objective needs all quantities");
  const std::lock_guard lock(parsed_->mutex);
  std::ranges::copy(values, parsed_->variables.begin());
  const double score = parsed_->parser.Eval();
  return std::isfinite(score) ? score : worst_score;
}

}  // namespace mercury
