// SPDX-License-Identifier: Apache-2.0
#include "app/options/command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/options/option_values.h"

namespace mercury {

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

// CLI11 has no place for notes of ours. Its "option text" is for its own help pages, which we do not use.
Option Option::offering(const std::vector<std::string>& values) const {
  option_->option_text(fmt::format("offers {}", fmt::join(values, " ")));
  return *this;
}

Option Option::as_number(bool whole) const {
  option_->option_text(whole ? "whole number" : "number");
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
  if (option_->get_option_text().starts_with("offers "))
    for (const std::string_view value : split(std::string_view(option_->get_option_text()).substr(7), ' '))
      values.emplace_back(value);
  return values;
}

std::string Option::number_kind() const {
  return option_->get_option_text().ends_with("number") ? option_->get_option_text() : "";
}

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
void Command::hide() const { app_->group(""); }

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

bool Command::is_hidden() const { return app_->get_group().empty(); }

std::optional<Command> Command::parent() const {
  return app_->get_parent() ? std::optional(Command(*app_->get_parent())) : std::nullopt;
}

bool Command::is_within(const Command& other) const {
  for (const CLI::App* command = app_; command; command = command->get_parent())
    if (command == other.app_) return true;
  return false;
}

std::vector<Command> Command::commands(bool also_hidden) const {
  std::vector<Command> list;
  for (CLI::App* child : app_->get_subcommands([](CLI::App*) { return true; }))
    if (also_hidden || !child->get_group().empty()) list.emplace_back(*child);
  return list;
}

std::optional<Command> Command::find_command(const std::string& name) const {
  for (const Command& child : commands(true))
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
