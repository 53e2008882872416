#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "daemon/commands/convert.hpp"
#include "daemon/commands/detect.hpp"
#include "daemon/commands/diagnose.hpp"
#include "daemon/commands/info.hpp"
#include "daemon/commands/publish.hpp"
#include "daemon/commands/record.hpp"
#include "daemon/commands/recover.hpp"
#include "daemon/commands/replay.hpp"
#include "daemon/commands/topics.hpp"
#include "daemon/commands/watch.hpp"
#include "daemon/service/standard_output.hpp"
#include "daemon/service/version.hpp"

namespace {

int run(int argc, char** argv) {
  // Exit codes of all programs of the project: 0 done, 1 found, 2 failed, 3 bad usage or input.
  int exit_code = 0;
  CLI::App app("The engineer's side of the model-plant-mismatch monitor.");
  app.set_version_flag("--version", mpm::daemon::version_text("mpm"));
  app.require_subcommand(1);
  mpm::daemon::add_detect(app, exit_code);
  mpm::daemon::add_diagnose(app, exit_code);
  mpm::daemon::add_info(app, exit_code);
  mpm::daemon::add_convert(app, exit_code);
  mpm::daemon::add_recover(app, exit_code);
  mpm::daemon::add_watch(app, exit_code);
  mpm::daemon::add_record(app, exit_code);
  mpm::daemon::add_replay(app, exit_code);
  mpm::daemon::add_publish(app, exit_code);
  mpm::daemon::add_topics(app, exit_code);
  mpm::daemon::add_echo(app, exit_code);
  mpm::daemon::add_hz(app, exit_code);
  mpm::daemon::add_delay(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 3;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  int exit_code = 2;
  try {
    exit_code = run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "mpm: error: " << error.what() << '\n';
  }
  if (mpm::daemon::finish_standard_output()) return exit_code;
  std::cerr << "mpm: error: standard output cannot be written to\n";
  return 2;
}
