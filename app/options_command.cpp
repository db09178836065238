#include "app/commands.h"
#include "core/pipeline/calibration_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace evical {

void addOptionsCommand(CLI::App& app, int& exit_code) {
  struct Arguments {
    bool markdown = false, yaml = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("options", "Every option: name, default, range, unit, help");
  command->add_flag("--markdown", arguments->markdown, "As docs/options.md has it");
  command->add_flag("--yaml", arguments->yaml, "As config/default.yaml has it")->excludes("--markdown");
  command->callback([arguments, &exit_code] {
    fmt::print("{}", arguments->markdown ? optionMarkdown() : arguments->yaml ? optionYaml() : optionText());
    exit_code = kDone;
  });
}

}  // namespace evical
