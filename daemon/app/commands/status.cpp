#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/load_unit.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/bus/domain_options.hpp"
#include "daemon/bus/plugin_status.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/host/clock.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "idl/reader.hpp"
#include "idl/wait_set.hpp"

namespace mpm::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kUnknown = 3;  // of a monitoring plug-in

struct StatusOptions {
  std::vector<std::string> config;
  std::vector<std::string> units;
  idl::DomainOptions domain;
  CLI::App* command = nullptr;  // knows which flags were given
  bus::AgeLimits limits;
  double wait_s = 3.0;
};

/// The last word of every unit's monitor.
class LastWords {
 public:
  void hear(const mpm_Health& health, const idl::SampleInfo& info) {
    if (health.unit == nullptr) return;
    Word& word = words_[health.unit];
    if (!info.valid) {
      word.gone = true;
      return;
    }
    word = {health.state == nullptr ? "" : health.state,
            health.detail == nullptr ? "" : health.detail,
            health.active_alarms,
            health.silenced_alarms,
            info.source_time_ns,
            false};
  }
  /// How many of `units` have spoken lately.
  [[nodiscard]] bool all_here(const std::vector<std::string>& units) const {
    return !units.empty() && std::all_of(units.begin(), units.end(), [this](const auto& unit) {
      return words_.count(unit) > 0;
    });
  }
  /// Of `units`, or of all that there are where it is empty.
  [[nodiscard]] std::vector<bus::MonitorWord> of(std::vector<std::string> units) const {
    if (units.empty())
      for (const auto& [unit, word] : words_) units.push_back(unit);
    std::vector<bus::MonitorWord> list;
    for (const std::string& unit : units) {
      bus::MonitorWord& entry = list.emplace_back();
      entry.unit = unit;
      const auto it = words_.find(unit);
      if (it == words_.end()) continue;
      const Word& word = it->second;
      entry.state = word.state;
      entry.detail = word.detail;
      entry.active_alarms = word.active_alarms;
      entry.silenced_alarms = word.silenced_alarms;
      entry.gone = word.gone;
      const auto age_ns = static_cast<double>(host::ArrivalClock().now_ns() - word.written_ns);
      entry.age_s = std::max(0.0, 1e-9 * age_ns);
    }
    return list;
  }

 private:
  struct Word {
    std::string state, detail;
    std::uint32_t active_alarms = 0, silenced_alarms = 0;
    std::int64_t written_ns = 0;
    bool gone = false;
  };
  std::map<std::string, Word> words_;
};

/// Where to ask for whom; no units: whoever is there.
struct Place {
  idl::DomainOptions domain;
  std::vector<std::string> units;
};

std::vector<bus::MonitorWord> ask(const Place& place, double wait_s, host::StopSignal& stop) {
  const idl::Participant participant(place.domain);
  idl::Reader<mpm_Health> reader(participant, idl::kHealthTopic, idl::health_qos());
  idl::WaitSet wait_set;
  wait_set.attach(reader.readable());
  LastWords words;
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(wait_s));
  while (Clock::now() < end && !stop.received() && !words.all_here(place.units))
    if (wait_set.wait(idl::kLongestWait))
      reader.take_with_info(
          [&](const mpm_Health& health, const idl::SampleInfo& info) { words.hear(health, info); });
  return words.of(place.units);
}

/// One after the other; a unit that speaks is heard within a second.
bus::PluginStatus ask(const std::vector<Place>& places, const StatusOptions& options) {
  host::StopSignal stop;
  host::set_up_logging("off");  // one line is all there may be
  std::vector<bus::MonitorWord> words;
  for (const Place& place : places)
    for (bus::MonitorWord& word : ask(place, options.wait_s, stop)) {
      word.place = bus::place_text(place.domain);
      words.push_back(std::move(word));
    }
  return bus::plugin_status(words, options.limits, bus::place_text(places.front().domain));
}

/// The units wanted, each where its file says; those without a file where the first file says.
std::vector<Place> places_of(const std::vector<config::UnitConfig>& units,
                             const StatusOptions& options) {
  std::vector<std::string> without = options.units;
  std::map<std::string, std::size_t> known;  // by network settings
  std::vector<Place> places;
  for (const config::UnitConfig& unit : units) {
    const idl::DomainOptions domain = with_flags(
        *options.command, bus::domain_options(unit.dds, options.domain.role), options.domain);
    const bool wanted = options.units.empty() || std::erase(without, unit.unit) > 0;
    if (!wanted && !places.empty()) continue;
    const auto [place, is_new] = known.try_emplace(idl::domain_xml(domain), places.size());
    if (is_new) places.push_back({domain, {}});
    if (wanted) places[place->second].units.push_back(unit.unit);
  }
  Place& first = places.front();
  first.units.insert(first.units.end(), without.begin(), without.end());
  if (first.units.empty()) places.erase(places.begin());
  return places;
}

int status(const StatusOptions& options) {
  std::vector<Place> places = {{options.domain, options.units}};
  if (!options.config.empty()) {
    const config::LoadUnitsResult loaded = config::load_units(options.config);
    if (!loaded.ok() || loaded.units.empty()) {
      std::cout << "MPM UNKNOWN: "
                << (loaded.findings.empty() ? "no unit files"
                                            : config::format(loaded.findings.front()))
                << '\n';
      return kUnknown;
    }
    places = places_of(loaded.units, options);
  }
  try {
    const bus::PluginStatus status = ask(places, options);
    std::cout << status.line << '\n';
    return status.code;
  } catch (const std::exception& error) {
    std::cout << "MPM UNKNOWN: " << error.what() << '\n';
    return kUnknown;
  }
}

}  // namespace

void add_status(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("status", "one line for a monitoring system (Nagios, Icinga, Zabbix ...)");
  const auto options = std::make_shared<StatusOptions>();
  options->command = command;
  command->add_option("-c,--config", options->config,
                      "unit file, or folder of unit files: who must be there, and on which domain");
  command->add_option("--unit", options->units, "only this unit, which must be there; repeatable")
      ->allow_extra_args(false);
  add_bus_flags(*command, options->domain);
  command
      ->add_option("--warning", options->limits.warning_s, "age of the last health, as 90 or 5min")
      ->capture_default_str()
      ->transform(positive_time_value());
  command->add_option("--critical", options->limits.critical_s, "the same")
      ->capture_default_str()
      ->transform(positive_time_value());
  command->add_option("--wait", options->wait_s, "how long to listen at most, on each domain")
      ->capture_default_str()
      ->transform(positive_time_value());
  command->footer(
      "Per unit after '|': alarms, age of the last health, state (0 OK, 1 WARNING, 2 CRITICAL).\n"
      "Ages compare this machine's clock with that of the monitor's.\n"
      "Example:\n  mpm status --config /etc/mpm/units\n"
      "Exit codes, those of monitoring plug-ins: 0 OK, 1 WARNING: alarms that nobody has\n"
      "silenced, or not normal,\n"
      "2 CRITICAL: failure, or no monitor, 3 UNKNOWN: it could not be found out, or bad usage");
  command->callback([options, &exit_code] { exit_code = status(*options); });
}

}  // namespace mpm::app
