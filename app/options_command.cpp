#include "app/command_line.h"
#include "app/commands.h"
#include "app/output.h"
#include "core/pipeline/session/option_pages.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

namespace evical {

void addOptionsCommand(Command& app, int& exit_code) {
  struct Arguments {
    bool all = false, tuning = false, markdown = false, yaml = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  Command command = app.command("options", "Options that people turn: name, default, range, unit, help");
  command.flag("--all", arguments->all, "Those for who knows the method, too");
  command.flag("--tuning", arguments->tuning, "Those for tests and developers, too").hide();
  const Argument markdown = command.flag("--markdown", arguments->markdown, "As docs/options.md has it");
  command.flag("--yaml", arguments->yaml, "As config/default.yaml has it").excludes(markdown);
  command.action([arguments, &exit_code] {
    print("{}", arguments->markdown ? optionMarkdown()
                : arguments->yaml   ? optionYaml()
                : arguments->tuning ? optionText(Level::Tuning)
                                    : optionText(arguments->all ? Level::Expert : Level::Public));
    exit_code = kDone;
  });
}

}  // namespace evical
