#include "app/commands.h"
#include "app/output.h"
#include "core/pipeline/option_pages.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace evical {

void addOptionsCommand(CLI::App& app, int& exit_code) {
  struct Arguments {
    bool all = false, markdown = false, yaml = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("options", "Options that people turn: name, default, range, unit, help");
  command->add_flag("--all", arguments->all, "Those for who knows the method, too");
  command->add_flag("--markdown", arguments->markdown, "As docs/options.md has it");
  command->add_flag("--yaml", arguments->yaml, "As config/default.yaml has it")->excludes("--markdown");
  command->callback([arguments, &exit_code] {
    print("{}", arguments->markdown ? optionMarkdown()
                : arguments->yaml   ? optionYaml()
                                    : optionText(arguments->all));
    exit_code = kDone;
  });
}

}  // namespace evical
