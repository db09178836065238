#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "core/base/error.h"
#include "core/report/export/export_target.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {
namespace {

struct Arguments {
  std::filesystem::path result, output;
  std::vector<std::string> targets;
};

std::string targetList() {
  std::string text = "Targets, each written to a folder of its name:\n";
  for (const ExportTarget& target : exportTargets())
    text += fmt::format("  {:<14} {}\n", target.name, target.description);
  return text;
}

int run(const Arguments& arguments) {
  const std::stop_token stop = stopOnSignals();  // files appear whole, or not at all
  for (const std::string& target : arguments.targets) exportTarget(target, "--to");
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(arguments.result, ignored);
  const std::filesystem::path file = folder ? arguments.result / "result.yaml" : arguments.result;
  const ExportedFiles exported = exportResult(readResultYaml(file), arguments.targets);
  if (stop.stop_requested()) throw Cancelled{};
  writeExportedFiles(arguments.output, exported.files);
  for (const FileContent& written : exported.files) print("{}\n", (arguments.output / written.path).string());
  for (const std::string& note : exported.notes) print("{}\n", note);
  for (const std::string& refusal : exported.refused) printError(refusal + "\n");
  return exported.refused.empty() ? kDone : kFailed;
}

}  // namespace

void addExportCommand(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand("export", "A result in other programs' formats");
  command->add_option("RESULT", arguments->result, "result.yaml, or the folder that has it")->required();
  command->add_option("--to", arguments->targets, "Targets, separated by commas")->required()->delimiter(',');
  command->add_option("-o,--output", arguments->output, "Folder for the targets' folders")->required();
  command->footer(targetList());
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
