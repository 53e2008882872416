#include "daemon/app/commands/commands.hpp"

#include <chrono>
#include <iostream>
#include <memory>

#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/bus/survey.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "daemon/report/record_json.hpp"
#include "idl/wait_set.hpp"

namespace mpm::app {
namespace {

struct TopicsOptions {
  idl::DomainOptions domain;
  double duration_s = 1.5;
  bool json = false;
};

int topics(const TopicsOptions& options) {
  using Clock = std::chrono::steady_clock;
  host::StopSignal stop;
  host::set_up_logging("warning");
  const idl::Participant participant(options.domain);
  bus::Survey survey(participant);
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(options.duration_s));
  while (Clock::now() < end && !stop.received()) survey.listen(idl::kLongestWait);
  const std::vector<bus::TopicRow> rows = survey.rows();
  if (options.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const bus::TopicRow& row : rows) list.push_back(to_json(row));
    std::cout << report::json_text(list) << '\n';
  } else if (rows.empty()) {
    std::cout << "nobody else is on " << bus::place_text(options.domain) << '\n';
  } else {
    std::cout << to_text(rows);
  }
  return 0;
}

}  // namespace

void add_topics(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("topics", "list who reads and writes what on the bus");
  const auto options = std::make_shared<TopicsOptions>();
  add_domain_flags(*command, options->domain);
  command->add_option("--duration", options->duration_s, "how long to look around, as 90 or 1.5h")
      ->capture_default_str()
      ->transform(positive_time_value());
  command->add_flag("--json", options->json, "print one JSON array");
  command->footer(
      "Units are those whose samples went by; a slow unit needs a longer --duration.\n"
      "Example:\n  mpm topics --domain 3 --duration 10");
  command->callback([options, &exit_code] { exit_code = topics(*options); });
}

}  // namespace mpm::app
