// ./run boiler: the life of an MPC model on the recovery boiler, played with real processes over
// DDS and written as one page.
#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include "daemon/report/page/page.hpp"
#include "tests/boiler/page_data.hpp"
#include "tests/system/process.hpp"

namespace mpm::boiler {
namespace {

struct Options {
  std::string out = MPM_SOURCE_DIR "/docs/recovery_boiler.html", work;
  StoryPlan plan;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("--out", options.out, "the page")->capture_default_str();
  app.add_option("--seed", options.plan.seed, "of all random numbers")->capture_default_str();
  app.add_option("--work", options.work,
                 "folder for recordings, models and reports; without it they are not kept");
}

int run(const Options& options) {
  const std::filesystem::path out = std::filesystem::absolute(options.out);
  const test::TemporaryFolder temporary;
  std::string page;
  {
    Workshop workshop(options.work.empty() ? temporary.file("work") : options.work);
    page = report::page_html(page_data(play(workshop, options.plan)));
  }
  std::ofstream file(out, std::ios::binary);
  file << page;
  file.close();
  if (!file) throw StoryError("cannot write " + out.string());
  std::cout << out.string() << '\n';
  return 0;
}

}  // namespace
}  // namespace mpm::boiler

int main(int argc, char** argv) {
  CLI::App app("The life of an MPC model on the recovery boiler, as one page.");
  mpm::boiler::Options options;
  mpm::boiler::declare(app, options);
  try {
    app.parse(argc, argv);
    return mpm::boiler::run(options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 3;
  } catch (const std::exception& error) {
    std::cerr << "mpm_boiler: error: " << error.what() << '\n';
    return 2;
  }
}
