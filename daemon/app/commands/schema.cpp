#include <CLI/CLI.hpp>
#include <iostream>

#include "daemon/app/commands/commands.hpp"
#include "daemon/report/record_json.hpp"
#include "daemon/report/unit_schema.hpp"

namespace mpm::app {

void add_schema(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command =
      app.add_subcommand("schema", "print the JSON Schema of unit files, for editors");
  command->footer(
      "Examples:\n"
      "  mpm schema >unit.schema.json\n"
      "First line of a unit file, for editors with a YAML language server:\n"
      "  # yaml-language-server: $schema=/usr/share/mpm/unit.schema.json\n"
      "Exit codes: 0 done, 2 failed, 3 bad usage");
  command->callback([] { std::cout << report::json_text(report::unit_schema(), 1) << '\n'; });
}

}  // namespace mpm::app
