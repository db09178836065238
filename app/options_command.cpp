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
  Command command = app.command("options", "List the common options: name, default, range, unit, help");
  command.flag("--all", arguments->all, "Include the options for experts");
  command.flag("--tuning", arguments->tuning, "Include the options for tests and developers").hide();
  const Argument markdown =
      command.flag("--markdown", arguments->markdown, "Print Markdown, the content of docs/options.md");
  command.flag("--yaml", arguments->yaml, "Print YAML, the content of config/default.yaml")
      .excludes(markdown);
  command.example("evical options --all");
  command.action([arguments, &exit_code] {
    print("{}", arguments->markdown ? optionMarkdown()
                : arguments->yaml   ? optionYaml()
                : arguments->tuning ? optionText(Level::Tuning)
                                    : optionText(arguments->all ? Level::Expert : Level::Public));
    exit_code = kDone;
  });
}

}  // namespace evical
