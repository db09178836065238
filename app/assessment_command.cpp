#include "app/assessment_command.h"

#include "app/commands.h"

namespace evical {

Argument addAssessmentArguments(Command& command, AssessmentArguments& arguments, const std::string& folder,
                                const std::string& groups) {
  command
      .option("--set", arguments.settings,
              "Option as group.option=value, see 'evical options'; " + groups + ". Can be repeated")
      .repeated();
  command.flag("--json", arguments.json, "Print JSON instead of tables, and nothing else");
  command.flag("--quiet", arguments.quiet, "Print only the tables and errors");
  command.footer(
      "Exit codes: 0 unchanged; 3 changed; 4 cannot tell, the last lines give advice; 1 cancelled; 2 bad "
      "usage or unusable files.");
  return command.option("-o,--output", arguments.output, folder);
}

void addThreads(Command& command, AssessmentArguments& arguments) {
  command.option("--threads", arguments.threads, "Threads of the optimisation").between(1, 256);
}

int exitCodeOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::Unchanged:
      return kDone;
    case Verdict::Changed:
      return kChanged;
    case Verdict::CannotTell:
      break;
  }
  return kCannotTell;
}

}  // namespace evical
