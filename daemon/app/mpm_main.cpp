#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "config/cli/decimals.hpp"
#include "config/cli/help_format.hpp"
#include "config/cli/slips.hpp"
#include "core/text/printable.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/host/standard_output.hpp"
#include "idl/version.hpp"

namespace mpm::app {
namespace {

int run(int argc, char** argv) {
  // Exit codes of all programs of the project: 0 done, 1 found, 2 failed, 3 bad usage or input.
  int exit_code = 0;
  CLI::App app("The engineer's side of the model-plant-mismatch monitor.", "mpm");
  app.formatter(std::make_shared<cli::HelpFormat>());
  app.set_version_flag("--version", idl::version_text("mpm"));
  app.require_subcommand(1);
  add_detect(app, exit_code);
  add_trend(app, exit_code);
  add_diagnose(app, exit_code);
  add_identify(app, exit_code);
  add_import(app, exit_code);
  add_info(app, exit_code);
  add_list(app, exit_code);
  add_convert(app, exit_code);
  add_recover(app, exit_code);
  add_watch(app, exit_code);
  add_record(app, exit_code);
  add_replay(app, exit_code);
  add_publish(app, exit_code);
  add_topics(app, exit_code);
  add_echo(app, exit_code);
  add_hz(app, exit_code);
  add_delay(app, exit_code);
  add_doctor(app, exit_code);
  add_status(app, exit_code);
  add_alarms(app, exit_code);
  add_alarm_actions(app, exit_code);
  add_journal(app, exit_code);
  add_schema(app, exit_code);
  add_keys(app, exit_code);
  add_completion(app, exit_code);
  add_man(app, exit_code);
  app.footer(
      "Examples:\n"
      "  mpm detect --config unit.yaml --data month.csv    which models are wrong?\n"
      "  mpm diagnose --config unit.yaml --data month.csv --out report    and how?\n"
      "  mpm identify --config unit.yaml --data test.csv --out new.yaml    a new model\n"
      "  mpm watch    what the monitors say, live\n"
      "  mpm record --config unit.yaml --output monday.mcap    what goes over the bus\n"
      "  mpm COMMAND --help    the options of a command, with examples\n"
      "Exit codes: 0 done, 1 found what was to be told, 2 failed, 3 bad usage or input");
  cli::read_decimals(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string slips = cli::slips_text(app);
    if (slips.empty())
      app.exit(error);
    else
      std::cerr << slips << "Run with --help for more information.\n";
    if (app.got_subcommand("status"))  // what asks it reads standard output alone
      std::cout << "MPM UNKNOWN: bad usage: "
                << printable(slips.empty() ? error.what() : slips.substr(0, slips.find('\n')))
                << '\n';
    return 3;
  }
  return exit_code;
}

}  // namespace
}  // namespace mpm::app

int main(int argc, char** argv) {
  int exit_code = 2;
  bool told = false;
  try {
    exit_code = mpm::app::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "mpm: error: " << error.what() << '\n';
    told = true;
  }
  if (mpm::host::finish_standard_output()) return exit_code;
  if (!told) std::cerr << "mpm: error: standard output cannot be written to\n";
  return 2;
}
