// Common parts of `evical check`, `evical maintain` and `evical repeat`: arguments, output, exit codes.
#pragma once

#include "app/command_line.h"
#include "app/console.h"
#include "app/output.h"
#include "core/base/file_places.h"
#include "core/base/progress.h"
#include "core/report/assessment_report.h"

#include <optional>
#include <string>
#include <vector>

namespace evical {

struct AssessmentArguments {
  std::string output;  // empty: no files are written
  std::vector<std::string> settings;
  int threads = 0;  // 0: from the options
  bool json = false, quiet = false;
};

// -o, --set, --json and --quiet; returns -o, which may be required. `groups`: the groups that --set accepts.
Argument addAssessmentArguments(Command& command, AssessmentArguments& arguments, const std::string& folder,
                                const std::string& groups);
void addThreads(Command& command, AssessmentArguments& arguments);

int exitCodeOf(Verdict verdict);

// `assess` returns the assessment and writes its files if a folder is given.
template <class Assess>
int runAssessment(const AssessmentArguments& arguments, const Assess& assess) {
  Console console(arguments.quiet || arguments.json);
  std::optional<NewFolder> folder;
  if (!arguments.output.empty()) {
    console.announceReplacement(arguments.output, {"check.yaml", "maintenance.yaml", "repeat.yaml"});
    folder.emplace(arguments.output);
  }
  const auto assessment = assess(console, RunContext{console, stopOnSignals()});
  console.stageStarted("done");
  print("{}", arguments.json ? assessmentJson(assessment) : assessmentTable(assessment));
  if (folder && !arguments.quiet && !arguments.json) print("Files are in {}\n", arguments.output);
  return exitCodeOf(assessment.verdict);
}

}  // namespace evical
