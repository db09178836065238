#include "app/command_line.h"
#include "app/commands.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/report/truth_comparison.h"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace evical {

void addCompareCommand(Command& app, int& exit_code) {
  struct Arguments {
    std::string result, truth;
  };
  auto arguments = std::make_shared<Arguments>();
  Command command = app.command("compare", "Compare a result with the truth of a simulated recording");
  command.option("RESULT", arguments->result, "result.yaml, or the folder of a run").required();
  command.option("TRUTH", arguments->truth, "truth.yaml, or the folder that contains it").required();
  command.example("evical compare result truth.yaml");
  command.action([arguments, &exit_code] {
    print("{}",
          comparisonTable(compareWithTruth(resultAt(arguments->result),
                                           readResultYaml(resultFileOf(arguments->truth, "truth.yaml")))));
    exit_code = kDone;
  });
}

}  // namespace evical
