#include "daemon/live/monitor_service.hpp"

#include <spdlog/spdlog.h>

#include <map>

#include "core/parallel/parallel.hpp"
#include "core/text/number_text.hpp"
#include "daemon/bus/domain_options.hpp"
#include "daemon/files/folder_name.hpp"
#include "daemon/keys/key_folder.hpp"
#include "daemon/live/report_store.hpp"
#include "daemon/live/unit_samples.hpp"

namespace mpm::live {
namespace {

constexpr std::chrono::milliseconds kLongestWait{200};
constexpr std::chrono::seconds kStatusPeriod{1};
// A layout of 8000 tags of the greatest length. Whoever sends more fills the memory.
constexpr int kLargestSampleKb = 1024;
constexpr std::size_t kMostInStatus = 3;  // units whose troubles are told

idl::DomainOptions settings_of(const config::UnitConfig& unit, const ServiceOptions& options) {
  idl::DomainOptions settings = bus::domain_options(unit.dds, "monitor");
  settings.use_environment = options.use_environment;
  settings.max_sample_kb = kLargestSampleKb;
  return settings;
}

// Each takes its samples again on a thread of its own, and tells nobody.
void recall(const std::vector<UnitPipeline*>& pipelines,
            const std::vector<config::UnitConfig>& units, const std::string& folder,
            const std::function<bool()>& stop) {
  std::vector<std::string> texts(units.size());
  const Parallel threads(available_threads());
  threads.for_each(units.size(), [&](std::size_t i) {
    const auto start = std::chrono::steady_clock::now();
    const std::string text = pipelines[i]->recall(samples_of(units[i], units.size(), folder), stop);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    texts[i] = fmt::format("{}: {} ({:.1f} s)", units[i].unit, text, seconds.count());
  });
  for (const std::string& text : texts) spdlog::info(text);
}

}  // namespace

MonitorService::MonitorService(const std::vector<config::UnitConfig>& units,
                               const ServiceOptions& options, DiagnosisWorker& worker)
    : gate_(options.token),
      longest_wait_(options.standby_rank ? Role::kPeriod : kLongestWait),
      commands_(options.commands) {
  if (!options.alarm_journal.empty()) alarm_journal_.emplace(options.alarm_journal);
  if (!options.sample_journal.empty()) samples_.emplace(options.sample_journal);
  idl::DomainOptions any;
  any.use_environment = options.use_environment;
  if (idl::ignores_environment(any))
    spdlog::warn(
        "CYCLONEDDS_URI is set, but the unit files' DDS settings are used; --dds-from-environment "
        "takes it instead");
  const Clock::time_point now = Clock::now();
  // A reader takes samples from its start on, hence knows all units of its domain then.
  std::map<std::string, std::vector<std::string>> units_of;  // by their settings
  for (const config::UnitConfig& unit : units)
    units_of[idl::domain_xml(settings_of(unit, options))].push_back(unit.unit);
  std::map<std::string, Domain*> domain_of;
  int asker = options.first_asker;
  std::vector<UnitPipeline*> pipelines;
  for (const config::UnitConfig& unit : units) {
    const idl::DomainOptions settings = settings_of(unit, options);
    const std::string xml = idl::domain_xml(settings);
    Domain*& domain = domain_of[xml];
    if (domain == nullptr) {
      domain = domains_
                   .emplace_back(std::make_unique<Domain>(settings, units_of[xml], gate_,
                                                          options.standby_rank))
                   .get();
      domain->attach_to(wait_set_);
    }
    UnitPipeline& pipeline = domain->add_unit(unit, samples_ ? &*samples_ : nullptr, now);
    if (!settings.security.empty())
      pipeline.set_keys_until(keys::valid_until(settings.security + "/" + settings.role));
    if (!options.journal.empty())
      pipeline.keep({unit, history::JournalFiles(options.journal, files::folder_name(unit.unit),
                                                 options.journal_keep / units.size())});
    pipeline.diagnose_with(worker, asker++);
    if (options.observer) pipeline.show_to(options.observer(unit));
    pipelines.push_back(&pipeline);
  }
  if (!options.samples.empty()) recall(pipelines, units, options.samples, options.stop);
  for (std::size_t i = 0; i < units.size(); ++i) {
    const config::UnitConfig& unit = units[i];
    UnitPipeline& pipeline = *pipelines[i];
    if (alarm_journal_) pipeline.keep(*alarm_journal_);
    pipeline.announce();
    if (unit.monitor.diagnosis_samples > 0) pipeline.set_report_problem(options.report_problem);
    spdlog::info(
        "{}: watching {} on domain {}{}", unit.unit,
        counted(static_cast<std::uint64_t>(unit.counts().inputs() * unit.counts().cv), "channel"),
        unit.dds.domain, unit.dds.partition.empty() ? "" : ", partition " + unit.dds.partition);
  }
}

void MonitorService::run(const std::function<bool()>& stop) {
  notifier_.status(status());
  notifier_.ready();
  Clock::time_point next_status{};
  while (!stop()) {
    const bool readable = wait_set_.wait(longest_wait_);
    const Clock::time_point now = Clock::now();
    for (const auto& domain : domains_) {
      domain->settle_roles(now);
      if (readable) domain->poll(now);
      domain->tick(now);
    }
    if (commands_ != nullptr)
      commands_->serve([this](const AlarmCommand& command) { return carry_out(command); },
                       [this](const AlarmCommand& command, const std::string& why) {
                         if (UnitPipeline* unit = find(command.unit))
                           unit->refuse(command, std::string(to_string(command.action)), why);
                       });
    const auto disturbed = [this] { return wait_set_.ready(); };
    for (const auto& domain : domains_)
      if (domain->rest(disturbed)) break;
    notifier_.feed_watchdog(now);
    if (now < next_status) continue;
    next_status = now + kStatusPeriod;
    notifier_.status(status());
  }
}

UnitPipeline* MonitorService::find(const std::string& unit) const {
  for (const auto& domain : domains_)
    if (const auto it = domain->units().find(unit); it != domain->units().end())
      return it->second.get();
  return nullptr;
}

CommandReply MonitorService::carry_out(const AlarmCommand& command) {
  UnitPipeline* unit = find(command.unit);
  return unit == nullptr ? CommandReply{false, "there is no unit " + command.unit}
                         : unit->obey(command);
}

std::string MonitorService::status() const {
  std::uint64_t units = 0, standing_by = 0, matching = 0, mismatching = 0, undetermined = 0,
                alarms = 0, silenced = 0;
  for (const auto& domain : domains_) {
    for (const auto& [name, unit] : domain->units()) {
      const HealthRecord& health = unit->health();
      ++units;
      if (unit->stands_by()) ++standing_by;
      matching += health.matching;
      mismatching += health.mismatching;
      undetermined += health.undetermined;
      alarms += health.active_alarms;
      silenced += health.silenced_alarms;
    }
  }
  std::string text = counted(units, "unit") +
                     fmt::format("; channels: {} match, {} mismatch, {} undetermined; ", matching,
                                 mismatching, undetermined) +
                     bus::alarms_text(alarms, silenced);
  if (standing_by > 0) text += fmt::format("; stands by for {} of them", standing_by);
  std::size_t troubled = 0;
  for (const auto& domain : domains_)
    for (const auto& [name, unit] : domain->units())
      if (!unit->trouble_text().empty() && ++troubled <= kMostInStatus)
        text += "; " + name + ": " + unit->trouble_text();
  if (troubled > kMostInStatus)
    text += "; " + counted(troubled - kMostInStatus, "more unit") + " in trouble";
  return text;
}

}  // namespace mpm::live
