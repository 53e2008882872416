#include "tests/boiler/live_run.hpp"

#include <csignal>
#include <filesystem>
#include <map>
#include <utility>

#include "daemon/report/record_json.hpp"
#include "idl/output_readers.hpp"
#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::boiler {
namespace {

constexpr std::chrono::seconds kToAnswer{60};
constexpr std::chrono::seconds kToEnd{10};

/// What the monitor has published last of each channel.
class Published {
 public:
  explicit Published(const idl::DomainOptions& domain)
      : participant_(domain), readers_(participant_) {}

  /// Waits until all `channels` are told of the run's last sample; false where that does not come.
  [[nodiscard]] bool complete(std::size_t channels, std::int64_t last_interval) {
    return idl::eventually(
        [&] {
          for (const idl::Output& output : readers_.take())
            if (const auto* record = std::get_if<ChannelRecord>(&output))
              last_[{record->mv, record->cv}] = *record;
          std::size_t done = 0;
          for (const auto& [channel, record] : last_) done += record.interval == last_interval;
          return done == channels;
        },
        kToAnswer);
  }

  /// As `mpm detect` writes a channel.
  [[nodiscard]] Json channel(const std::string& mv, const std::string& cv) const {
    const auto found = last_.find({mv, cv});
    if (found == last_.end()) return nullptr;
    Json json = report::json_of(found->second);
    for (const char* key : {"record", "unit", "interval", "time_ns"}) json.erase(key);
    return json;
  }

 private:
  idl::Participant participant_;
  idl::OutputReaders readers_;
  std::map<std::pair<std::string, std::string>, ChannelRecord> last_;
};

/// A program that runs until it is told to end.
class Companion {
 public:
  Companion(Workshop& workshop, Command command)
      : command_(std::move(command)),
        errors_(workshop.log_name(command_.front())),
        process_(command_, workshop.log_name(command_.front()), errors_) {}

  void end() {
    process_.send(SIGTERM);
    if (process_.wait(kToEnd) != 0)
      throw StoryError(typed(command_) + ": did not end as it should\n" + test::read_file(errors_));
  }

 private:
  Command command_;
  std::string errors_;
  test::Process process_;
};

}  // namespace

LiveRun play_live(Workshop& workshop, const LivePlan& plan) {
  LiveRun run;
  run.recording = plan.name + ".mcap";
  const idl::DomainOptions domain = idl::test_domain("boiler-" + plan.name);
  const Command place = {"--domain", std::to_string(domain.domain), "--partition",
                         domain.partition};
  const auto remember = [&](Command command, bool on_bus) {
    if (on_bus) command.insert(command.end(), place.begin(), place.end());
    run.commands.push_back(std::move(command));
    return run.commands.back();
  };
  Published published(domain);
  Companion monitor(workshop, remember({"mpmd", "--config", plan.model}, true));
  std::filesystem::remove(run.recording);  // of an earlier story
  Companion recorder(workshop, remember({"mpm", "record", "--output", run.recording}, true));
  workshop.run(remember(
      {"mpmsim", "--config", kPlant, "--scenario", plan.scenario, "--controller-model", plan.model,
       "--samples", std::to_string(plan.samples), "--seed", std::to_string(plan.seed),
       "--start-time", "0", "--speed", "0", "--readers", "2", "--wait-readers", "30"},
      true));
  recorder.end();
  run.detect = Json::parse(workshop.run(remember(
      {"mpm", "detect", "--config", plan.model, "--data", run.recording, "--json"}, false)));
  const Json& channels = run.detect["channels"];
  if (!published.complete(channels.size(), plan.samples - 1))
    throw StoryError(plan.name + ": mpmd did not answer for all channels");
  monitor.end();
  run.same_answer = run.detect["samples"] == plan.samples;
  for (const Json& channel : channels)  // as text: what is not known equals itself
    run.same_answer =
        run.same_answer && channel.dump() == published.channel(channel["mv"], channel["cv"]).dump();
  return run;
}

}  // namespace mpm::boiler
