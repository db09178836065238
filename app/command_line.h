// Commands, arguments and options, without the command line library, whose templates are slow to compile.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace evical {

// The command line is invalid. what() is one sentence without a full stop, or ends with a question.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
UsageError missingOption(const std::string& name);
UsageError excludedOption(const std::string& name, const std::string& other);

// One argument or option of a command.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  Argument& required();
  Argument& between(int least, int most);
  Argument& between(double least, double most);
  Argument& oneOf(const std::vector<std::string>& words);
  Argument& folder();                              // must exist
  Argument& repeated();                            // may be given several times, each with one value
  Argument& separatedBy(char delimiter);           // several values in one argument
  Argument& valueOptional(const std::string& as);  // `as`: name of the value in help
  Argument& showDefault();
  Argument& defaultText(const std::string& text);
  Argument& needs(const Argument& other);
  Argument& excludes(const Argument& other);
  void hide();  // from help
  bool isGiven() const;

 private:
  CLI::Option* option_;
};

// A command, or the program itself. Copies refer to the same command. Variables must outlive the parsing.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  Command command(const std::string& name, const std::string& description);
  // `names`: "-o,--output" for an option, "RECORDING" for an argument. Value: std::string,
  // std::filesystem::path, vectors of both, int, double, std::vector<double>, std::optional<double>.
  template <class Value>
  Argument option(const std::string& names, Value& value, const std::string& help);
  Argument option(const std::string& names, const std::function<void(const std::string&)>& take,
                  const std::string& help);
  Argument flag(const std::string& names, bool& value, const std::string& help);
  void footer(const std::string& text);
  void example(const std::string& command_line);  // at the end of help
  void hide();                                    // from help
  void action(const std::function<void()>& action);
  const CLI::App& app() const { return *app_; }

 protected:
  CLI::App* app_;
};

// The program's command line.
class CommandLine : public Command {
 public:
  explicit CommandLine(const std::string& description, const std::string& name = {});
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  void version(const std::string& text);
  void requireCommand();
  // Sets the variables and runs the chosen command's action. Returns false after printing only help or the
  // version. Throws UsageError.
  bool parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> owned_;
};

}  // namespace evical
