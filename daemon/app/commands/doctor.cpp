#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/load_unit.hpp"
#include "core/text/number_text.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/bus/doctor/examination.hpp"
#include "daemon/bus/domain_options.hpp"
#include "daemon/files/aligning.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "idl/wait_set.hpp"

namespace mpm::app {
namespace {

using Clock = std::chrono::steady_clock;

// How long to look where nobody says it: a slow unit must have had its turn.
constexpr double kShortestS = 5.0, kLongestS = 180.0, kSampleTimes = 3.0;

struct DoctorOptions {
  std::vector<std::string> config;
  idl::DomainOptions domain;
  CLI::App* command = nullptr;  // knows which flags were given
  double seconds = 0.0;         // 0: as long as the units need
  bool json = false;
};

Clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// Where to look, and what should be there; no units: whatever is.
struct Place {
  idl::DomainOptions domain;
  std::vector<bus::ExpectedInputs> units;
};

bus::Findings examine(const Place& place, double seconds, host::StopSignal& stop) {
  if (seconds == 0.0) {
    seconds = kShortestS;
    for (const bus::ExpectedInputs& unit : place.units)
      seconds = std::max(seconds, kSampleTimes * unit.sample_time_s);
    seconds = std::min(seconds, kLongestS);
    if (seconds > kShortestS)
      std::cerr << "mpm doctor: listening for " << number_text(seconds)
                << " s, for so slow a unit; --seconds makes it shorter\n";
  }
  const idl::Participant participant(place.domain);
  bus::Examination examination(participant, bus::place_text(place.domain), place.units,
                               duration_of(seconds));
  const Clock::time_point end = Clock::now() + duration_of(seconds);
  while (!stop.received() && Clock::now() < end) examination.listen(idl::kLongestWait);
  examination.listen(idl::kLongestWait);
  bus::Findings findings = examination.findings();
  if (idl::ignores_environment(place.domain))
    findings.notes.emplace_back(
        "CYCLONEDDS_URI is set and was not used; --dds-from-environment takes it");
  return findings;
}

// One after the other. 0, or 1 if something is wrong.
int examine(const DoctorOptions& options, const std::vector<Place>& places,
            host::StopSignal& stop) {
  std::vector<bus::Findings> found;
  for (const Place& place : places) {
    found.push_back(examine(place, options.seconds, stop));
    if (stop.received()) break;
  }
  const bus::Findings findings = bus::joined(std::move(found));
  if (options.json)
    std::cout << to_json(findings).dump(-1, ' ', false,
                                        nlohmann::ordered_json::error_handler_t::replace)
              << '\n';
  else
    std::cout << to_text(findings);
  return findings.all_well() ? 0 : 1;
}

int doctor(const DoctorOptions& options) {
  host::StopSignal stop;  // before any thread
  host::set_up_logging("error");
  std::vector<Place> places = {{options.domain, {}}};
  if (!options.config.empty()) {
    const config::LoadUnitsResult loaded = config::load_units(options.config);
    for (const config::Finding& finding : loaded.findings) std::cerr << format(finding) << '\n';
    if (!loaded.ok() || loaded.units.empty()) return 3;
    places.clear();
    std::map<std::string, std::size_t> known;  // by network settings
    for (const config::UnitConfig& unit : loaded.units) {
      const idl::DomainOptions domain = with_flags(
          *options.command, bus::domain_options(unit.dds, options.domain.role), options.domain);
      const auto [place, is_new] = known.try_emplace(idl::domain_xml(domain), places.size());
      if (is_new) places.push_back({domain, {}});
      places[place->second].units.push_back(bus::expected_inputs(
          unit, files::needed_kinds(unit), files::aligner_settings(unit).welcome));
    }
  }
  return examine(options, places, stop);
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("doctor", "say what is wrong between gateway, bus and monitor");
  const auto options = std::make_shared<DoctorOptions>();
  options->command = command;
  command->add_option(
      "-c,--config", options->config,
      "unit file, or folder of unit files: what should be there, and on which domain; "
      "without it, whatever is on the domain");
  add_bus_flags(*command, options->domain);
  command
      ->add_option("--seconds", options->seconds,
                   "how long to look on each domain, as 90 or 1.5h (default: three sample times, 5 "
                   "s to 180 s)")
      ->transform(positive_time_value());
  command->add_flag("--json", options->json, "print one JSON object");
  command->footer(
      "Writes nothing to the bus.\n"
      "Examples:\n"
      "  mpm doctor --config shell.yaml\n"
      "  mpm doctor --domain 3 --seconds 30 --json\n"
      "Exit codes: 0 all is well, 1 something is wrong, 2 failed, 3 bad usage or bad unit file");
  command->callback([options, &exit_code] { exit_code = doctor(*options); });
}

}  // namespace mpm::app
