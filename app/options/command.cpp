// SPDX-License-Identifier: Apache-2.0
#include "app/options/command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "app/options/option_values.h"

namespace mercury {
namespace {

// CLI11 has no place for notes of ours. Its "option text" is for its own help pages, which we do not use: it holds a
// note per line.
constexpr std::string_view offers = "offers ", first_screen = "first screen";

void add_note(CLI::Option& option, std::string_view note) {
  option.option_text(fmt::format("{}{}\n", option.get_option_text(), note));
}

// The rest of the note that begins so; none if there is no such note.
std::optional<std::string> note_of(const CLI::Option& option, std::string_view beginning) {
  for (const std::string_view note : split(option.get_option_text(), '\n'))
    if (note.starts_with(beginning)) return std::string(note.substr(beginning.size()));
  return std::nullopt;
}

}  // namespace

Option Option::in_group(const std::string& heading) const {
  option_->group(heading);
  return *this;
}

Option Option::with_form(const std::string& form) const {
  option_->type_name(form);
  return *this;
}

Option Option::with_help(const std::string& help) const {
  option_->description(help);
  return *this;
}

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::one_value_each() const {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::offering(const std::vector<std::string>& values) const {
  add_note(*option_, fmt::format("{}{}", offers, fmt::join(values, " ")));
  return *this;
}

Option Option::as_number(bool whole) const {
  add_note(*option_, whole ? "whole number" : "number");
  return *this;
}

Option Option::on_first_screen() const {
  add_note(*option_, first_screen);
  return *this;
}

bool Option::is_positional() const { return option_->get_positional(); }
std::string Option::name() const { return option_->get_single_name(); }

std::vector<std::string> Option::short_names() const {
  std::vector<std::string> names;
  for (const std::string& name : option_->get_snames()) names.push_back("-" + name);
  return names;
}

std::vector<std::string> Option::long_names() const {
  std::vector<std::string> names;
  for (const std::string& name : option_->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string Option::help() const { return option_->get_description(); }
std::string Option::group() const { return option_->get_group(); }
std::string Option::form() const { return option_->get_type_name(); }
bool Option::is_required() const { return option_->get_required(); }
bool Option::takes_value() const { return option_->get_items_expected_max() > 0; }
bool Option::takes_last() const { return option_->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeLast; }

bool Option::takes_several() const {
  return option_->get_expected_max() >= CLI::detail::expected_max_vector_size && option_->get_allow_extra_args();
}

std::vector<std::string> Option::offered() const {
  std::vector<std::string> values;
  if (const std::optional<std::string> words = note_of(*option_, offers))
    for (const std::string_view value : split(*words, ' ')) values.emplace_back(value);
  return values;
}

std::string Option::number_kind() const {
  for (const char* kind : {"number", "whole number"})
    if (note_of(*option_, kind)) return kind;
  return "";
}

bool Option::is_on_first_screen() const { return note_of(*option_, first_screen).has_value(); }

bool Option::is_given() const { return option_->count() > 0; }
std::vector<std::string> Option::values() const { return option_->results(); }

Command Command::add_command(const std::string& name, const std::string& help) const {
  return Command(*app_->add_subcommand(name, help));
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& help) const {
  return Option(*app_->add_flag(name, value, help));
}

Option Command::add_flag(const std::string& name, std::function<void()> given, const std::string& help) const {
  return Option(*app_->add_flag_callback(name, std::move(given), help));
}

Option Command::add_option(const std::string& name, std::function<void(const std::string&)> take,
                           const std::string& help, const std::string& form) const {
  return Option(*app_->add_option_function<std::string>(name, std::move(take), help)
                     ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
                     ->type_name(form));
}

Option Command::add_list(const std::string& name, std::vector<std::string>& values, const std::string& help) const {
  return Option(*app_->add_option(name, values, help));
}

Option Command::help_option() const { return Option(*app_->get_help_ptr()); }

Option Command::add_version_option(const std::string& name, const std::string& version, const std::string& help) const {
  return Option(*app_->set_version_flag(name, version, help));
}

void Command::remove_option(const std::string& name) const { app_->remove_option(app_->get_option_no_throw(name)); }
void Command::set_footer(const std::string& text) const { app_->footer(text); }
void Command::when_chosen(std::function<void()> action) const { app_->callback(std::move(action)); }
void Command::require_command() const { app_->require_subcommand(1); }

std::string Command::name() const { return app_->get_name(); }

std::string Command::full_name() const {
  const std::optional<Command> above = parent();
  return above ? above->full_name() + " " + name() : name();
}

std::string Command::help() const { return app_->get_description(); }

// A command of CLI11 starts with the footer of the command above it.
std::string Command::footer() const {
  const CLI::App* above = app_->get_parent();
  return above && above->get_footer() == app_->get_footer() ? "" : app_->get_footer();
}

std::optional<Command> Command::parent() const {
  return app_->get_parent() ? std::optional(Command(*app_->get_parent())) : std::nullopt;
}

bool Command::is_within(const Command& other) const {
  for (const CLI::App* command = app_; command; command = command->get_parent())
    if (command == other.app_) return true;
  return false;
}

std::vector<Command> Command::commands() const {
  std::vector<Command> list;
  for (CLI::App* child : app_->get_subcommands([](CLI::App*) { return true; })) list.emplace_back(*child);
  return list;
}

std::optional<Command> Command::find_command(const std::string& name) const {
  for (const Command& child : commands())
    if (child.name() == name) return child;
  return std::nullopt;
}

std::vector<Option> Command::options() const {
  std::vector<Option> list;
  for (CLI::Option* option : app_->get_options([](CLI::Option*) { return true; })) list.emplace_back(*option);
  return list;
}

std::optional<Option> Command::find_option(const std::string& name) const {
  CLI::Option* option = app_->get_option_no_throw(name);
  return option ? std::optional(Option(*option)) : std::nullopt;
}

bool Command::is_given(const std::string& option) const {
  const std::optional<Option> found = find_option(option);
  return found && found->is_given();
}

CommandTree::CommandTree(const std::string& name, const std::string& help)
    : app_(std::make_unique<CLI::App>(help, name)) {
  app_->set_help_flag("-h,--help", "Print help: -h the most used options, --help all");
  app_->require_subcommand(0, 1);  // after a command, its name and those of others are words: folders, robots
}

CommandTree::~CommandTree() = default;
CommandTree::CommandTree(CommandTree&&) noexcept = default;
CommandTree& CommandTree::operator=(CommandTree&&) noexcept = default;

Command CommandTree::root() const { return Command(*app_); }

ParsedRequest CommandTree::parse(const std::vector<std::string>& arguments) const {
  try {
    app_->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& request) {
    return request.get_name() == "CallForVersion" ? ParsedRequest::version : ParsedRequest::help;
  } catch (const CLI::ExtrasError&) {
    const std::vector<std::string> rest = app_->remaining(true);
    throw UnknownArgument{rest.empty() ? "" : rest.front()};
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string what = error.what();
    throw MissingValue{what.substr(0, what.find(':'))};
  } catch (const CLI::ParseError& error) {
    throw ParseFailure{error.what()};
  }
  return ParsedRequest::run;
}

}  // namespace mercury
