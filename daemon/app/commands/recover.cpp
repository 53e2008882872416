#include "daemon/app/commands/commands.hpp"

#include <iostream>
#include <memory>
#include <string>

#include "config/finding.hpp"
#include "config/replacement_file.hpp"
#include "core/text/number_text.hpp"
#include "daemon/mcap/recover.hpp"

namespace mpm::app {
namespace {

/// night.mcap -> night.recovered.mcap
std::string default_output(const std::string& input) {
  constexpr std::string_view kEnding = ".mcap";
  const bool ends = input.ends_with(kEnding);
  return (ends ? input.substr(0, input.size() - kEnding.size()) : input) + ".recovered.mcap";
}

// 0, or 3 on bad input, such as one of which nothing can be kept.
int run_recover(const std::string& input, const std::string& output) {
  try {
    config::refuse_to_replace({input}, output);
    config::ReplacementFile file(output);
    const mcap::RecoverReport report = mcap::recover(input, {file.temporary(), file.descriptor()});
    for (const std::string& problem : report.problems)
      std::cerr << input << ": " << problem << '\n';
    if (!report.whole && report.messages == 0) {
      std::cerr << input << ": error: no message of it can be kept; nothing was written\n";
      return 3;
    }
    file.commit();
    if (report.whole) std::cout << input << ": was whole; its index is new\n";
    std::cout << output << ": " << counted(report.messages, "message") << " of "
              << counted(report.channels, "channel") << " in " << counted(report.chunks, "chunk");
    if (report.torn_messages > 0)
      std::cout << ", " << report.torn_messages << " of them from the chunk that was cut off";
    std::cout << "; " << counted(report.lost_bytes, "byte") << " of the old file lost\n"
              << std::flush;
    return 0;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_recover(CLI::App& app, int& exit_code) {
  auto input = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "recover", "Mend a recording that has no end or is damaged: keep all that can be read");
  command->add_option("input", *input, "MCAP recording")->required();
  command->add_option(
      "--output", *output,
      "where to write it, not over IN (default: IN.recovered.mcap); replaces an older "
      "file when it is whole");
  command->footer("Example:\n  mpm recover night.mcap --output night_mended.mcap");
  command->callback([input, output, &exit_code] {
    exit_code = run_recover(*input, output->empty() ? default_output(*input) : *output);
  });
}

}  // namespace mpm::app
