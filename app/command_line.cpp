#include "app/command_line.h"

#include "core/base/nearest_name.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace evical {
namespace {

std::vector<std::string> optionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    if (!option->get_group().empty())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> commandNames(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command :
       program.get_subcommands([](const CLI::App* each) { return !each->get_group().empty(); }))
    names.push_back(command->get_name());
  return names;
}

// The first word that was not understood, with the nearest known one. The library reports a missing option
// or command instead; empty if that is the cause.
std::string unknownWord(const CLI::App& program) {
  const std::vector<std::string> left = program.remaining(true);
  if (left.empty()) return {};
  const auto is_option = [](const std::string& word) { return word.size() > 1 && word.front() == '-'; };
  const auto option = std::find_if(left.begin(), left.end(), is_option);
  const std::vector<CLI::App*> parsed = program.get_subcommands();
  if (parsed.empty() && option != left.begin())
    return fmt::format("unknown command '{}'. {}", left.front(),
                       nameAdvice(left.front(), commandNames(program)));
  const CLI::App& command = parsed.empty() ? program : *parsed.front();
  if (option == left.end()) return {};
  const std::string name = option->substr(0, option->find('='));
  return fmt::format("unknown option {}. {}", name, nameAdvice(name, optionNames(command)));
}

}  // namespace

UsageError missingOption(const std::string& name) {
  return UsageError(name + " is required");
}

UsageError excludedOption(const std::string& name, const std::string& other) {
  return UsageError(name + " excludes " + other);
}

Argument& Argument::required() {
  option_->required();
  return *this;
}

Argument& Argument::between(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Argument& Argument::between(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Argument& Argument::oneOf(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Argument& Argument::folder() {
  option_->check(CLI::ExistingDirectory);
  return *this;
}

Argument& Argument::repeated() {
  option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

Argument& Argument::separatedBy(char delimiter) {
  option_->delimiter(delimiter);
  return *this;
}

Argument& Argument::valueOptional(const std::string& as) {
  option_->expected(0, 1)->type_name(as);
  return *this;
}

Argument& Argument::showDefault() {
  option_->capture_default_str();
  return *this;
}

Argument& Argument::defaultText(const std::string& text) {
  option_->default_str(text);
  return *this;
}

Argument& Argument::needs(const Argument& other) {
  option_->needs(other.option_);
  return *this;
}

Argument& Argument::excludes(const Argument& other) {
  option_->excludes(other.option_);
  return *this;
}

void Argument::hide() {
  option_->group("");
}

bool Argument::isGiven() const {
  return option_->count() > 0;
}

Command Command::command(const std::string& name, const std::string& description) {
  return Command(app_->add_subcommand(name, description));
}

template <class Value>
Argument Command::option(const std::string& names, Value& value, const std::string& help) {
  return Argument(app_->add_option(names, value, help));
}
template Argument Command::option(const std::string&, std::string&, const std::string&);
template Argument Command::option(const std::string&, std::vector<std::string>&, const std::string&);
template Argument Command::option(const std::string&, std::filesystem::path&, const std::string&);
template Argument Command::option(const std::string&, std::vector<std::filesystem::path>&,
                                  const std::string&);
template Argument Command::option(const std::string&, int&, const std::string&);
template Argument Command::option(const std::string&, double&, const std::string&);
template Argument Command::option(const std::string&, std::vector<double>&, const std::string&);
template Argument Command::option(const std::string&, std::optional<double>&, const std::string&);

Argument Command::option(const std::string& names, const std::function<void(const std::string&)>& take,
                         const std::string& help) {
  return Argument(app_->add_option_function<std::string>(names, take, help));
}

Argument Command::flag(const std::string& names, bool& value, const std::string& help) {
  return Argument(app_->add_flag(names, value, help));
}

void Command::footer(const std::string& text) {
  app_->footer(app_->get_footer() + (app_->get_footer().empty() ? "" : "\n") + text);
}

void Command::example(const std::string& command_line) {
  footer("Example:\n  " + command_line);
}

void Command::hide() {
  app_->group("");
}

void Command::action(const std::function<void()>& action) {
  app_->callback(action);
}

CommandLine::CommandLine(const std::string& description, const std::string& name)
    : Command(nullptr), owned_(std::make_unique<CLI::App>(description, name)) {
  app_ = owned_.get();
}

CommandLine::~CommandLine() = default;

void CommandLine::version(const std::string& text) {
  app_->set_version_flag("--version", text);
}

void CommandLine::requireCommand() {
  app_->require_subcommand(1);
}

bool CommandLine::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      const std::string unknown = unknownWord(*app_);
      if (!unknown.empty()) throw UsageError(unknown);
      throw UsageError(app_->get_subcommands().empty() && error.get_name() == "RequiredError"
                           ? "no command is given. Known names: " + joined(commandNames(*app_))
                           : error.what());
    }
    app_->exit(error);  // prints help or the version
    return false;
  }
}

}  // namespace evical
