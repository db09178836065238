#include "app/commands.h"
#include "app/output.h"
#include "core/report/truth_comparison.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace evical {

void addCompareCommand(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::string result, truth;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand("compare", "A result against a simulated recording's truth");
  command->add_option("RESULT", arguments->result, "result.yaml")->required();
  command->add_option("TRUTH", arguments->truth, "truth.yaml")->required();
  command->callback([arguments, &exit_code] {
    print("{}", comparisonTable(
                    compareWithTruth(readResultYaml(arguments->result), readResultYaml(arguments->truth))));
    exit_code = kDone;
  });
}

}  // namespace evical
