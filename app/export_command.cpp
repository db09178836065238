#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "core/base/error.h"
#include "core/export/export_target.h"
#include "core/export/read_back.h"
#include "core/pipeline/runs/saved_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {
namespace {

struct ExportArguments {
  std::filesystem::path result, output, checked;  // checked: files of an earlier run
  std::vector<std::string> targets;
  bool check = false;
};

constexpr const char* kAll = "all";

std::string targetList() {
  std::string text = "Targets, each written to a folder of the same name:\n";
  for (const ExportTarget& target : exportTargets())
    text += fmt::format("  {:<14} {}: {}\n", target.name, target.program, target.files);
  return text + fmt::format("  {:<14} all that can represent the result\n", kAll);
}

bool wantsAll(const std::vector<std::string>& targets) {
  return std::find(targets.begin(), targets.end(), kAll) != targets.end();
}

std::vector<std::string> namedTargets(const std::vector<std::string>& targets) {
  if (!wantsAll(targets)) {
    for (const std::string& target : targets) exportTarget(target, "--to");
    return targets;
  }
  std::vector<std::string> all;
  for (const ExportTarget& target : exportTargets()) all.emplace_back(target.name);
  return all;
}

// Reads the files as the target programs do; false if one would reject them or read other values.
bool checkAll(const NamedResult& result, const std::vector<std::string>& targets,
              const std::filesystem::path& folder, const std::stop_token& stop) {
  bool same = true;
  for (const std::string& target : targets) {
    if (stop.stop_requested()) throw Cancelled{};
    const ExportCheck check = checkExport(result, exportTarget(target, "--to"), folder);
    if (check.same)
      print("{}\n", check.text);
    else
      printError(check.text + "\n");
    same = same && check.same;
  }
  return same;
}

// Checks the given targets of an earlier export; by default all in the folder.
int checkEarlier(const ExportArguments& arguments, const NamedResult& result, const std::stop_token& stop) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(arguments.checked, ignored))
    throw badInput(arguments.checked.string(), "is not a folder of exported files",
                   "Give the folder of 'evical export -o'");
  std::vector<std::string> targets = namedTargets(arguments.targets);
  if (targets.empty() || wantsAll(arguments.targets))
    for (targets.clear(); const ExportTarget& target : exportTargets())
      if (std::filesystem::is_directory(arguments.checked / target.name, ignored))
        targets.emplace_back(target.name);
  if (targets.empty())
    throw badInput(arguments.checked.string(), "does not contain exported files",
                   "Write them with --to and -o: each target has a folder of its name");
  return checkAll(result, targets, arguments.checked, stop) ? kDone : kFailed;
}

int writeAndCheck(const ExportArguments& arguments, const NamedResult& result, const std::stop_token& stop) {
  const ExportedFiles exported = exportResult(result, namedTargets(arguments.targets));
  if (stop.stop_requested()) throw Cancelled{};
  writeExportedFiles(arguments.output, exported.files);
  for (const FileContent& written : exported.files) print("{}\n", (arguments.output / written.path).string());
  for (const std::string& note : exported.notes) print("{}\n", note);
  // With `all`, refusals are expected: some targets need two cameras or an IMU.
  const bool expected = wantsAll(arguments.targets);
  for (const std::string& refusal : exported.refused)
    if (expected)
      print("{}\n", refusal);
    else
      printError(refusal + "\n");
  const bool same = !arguments.check || checkAll(result, exported.targets, arguments.output, stop);
  return same && (expected || exported.refused.empty()) ? kDone : kFailed;
}

int run(const ExportArguments& arguments) {
  const std::stop_token stop = stopOnSignals();  // files are written completely or not at all
  namedTargets(arguments.targets);
  const NamedResult result = resultAt(arguments.result);
  return arguments.checked.empty() ? writeAndCheck(arguments, result, stop)
                                   : checkEarlier(arguments, result, stop);
}

// Writing needs targets and a folder; a check without writing has its own folder.
void checkTogether(const ExportArguments& arguments) {
  if (!arguments.checked.empty()) {
    if (!arguments.output.empty()) throw excludedOption("--check FOLDER", "--output");
    return;
  }
  if (arguments.targets.empty()) throw missingOption("--to");
  if (arguments.output.empty()) throw missingOption("--output");
}

}  // namespace

void addExportCommand(Command& app, int& exit_code) {
  const auto arguments = std::make_shared<ExportArguments>();
  Command command = app.command("export", "Export a result in formats of other programs");
  command.option("RESULT", arguments->result, "result.yaml, or the folder that contains it").required();
  command.option("--to", arguments->targets, "Targets, separated by commas, or all").separatedBy(',');
  command.option("-o,--output", arguments->output, "Output folder, with one folder per target");
  Argument check =
      command.option("--check", arguments->checked,
                     "Read the written files back as each target's program does, and compare them "
                     "with RESULT; with a FOLDER instead of -o, check the files written there before");
  check.valueOptional("[FOLDER]");
  command.footer(targetList());
  command.example("evical export result --to kalibr,openvins -o exported --check");
  command.action([arguments, check, &exit_code] {
    arguments->check = check.isGiven();
    checkTogether(*arguments);
    exit_code = run(*arguments);
  });
}

}  // namespace evical
