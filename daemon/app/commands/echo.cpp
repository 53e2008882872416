#include <csignal>
#include <cstdio>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>

#include "config/cli/number_value.hpp"
#include "core/text/printable.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/bus/sample_json.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "daemon/host/standard_output.hpp"
#include "daemon/report/record_json.hpp"
#include "idl/output_samples.hpp"
#include "idl/reader.hpp"
#include "idl/topic_catalog.hpp"
#include "idl/wait_set.hpp"

namespace mpm::app {
namespace {

using Clock = std::chrono::steady_clock;

// After which it says that nothing has come.
constexpr std::chrono::seconds kSilence{5};

struct EchoOptions {
  std::string topic;
  std::string unit;
  idl::DomainOptions domain;
  bool once = false;
  bool json = false;
  std::uint64_t count = 0;  // 0 = no end
  double duration_s = 0.0;  // 0 = until interrupted
};

const char* state_name(const idl::SampleInfo& info) {
  return info.state == idl::InstanceState::kDisposed ? "disposed" : "no_writers";
}

// Which instance it is: of all else a sample without data has nothing.
void add_key(nlohmann::ordered_json& line, const nlohmann::ordered_json& sample,
             const idl::SampleInfo& info) {
  line["state"] = state_name(info);
  for (const char* key : {"unit", "mv", "cv", "kind"})
    if (sample.contains(key)) line[key] = sample[key];
}

void print(const EchoOptions& options, const nlohmann::ordered_json& sample,
           const idl::SampleInfo& info) {
  if (options.json) {
    nlohmann::ordered_json line{{"topic", options.topic}, {"written_ns", info.source_time_ns}};
    if (info.valid)
      line["sample"] = sample;
    else
      add_key(line, sample, info);
    std::cout << line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
              << '\n';
  } else if (info.valid) {
    std::cout << bus::yaml_text(sample) << "---\n";
  } else {
    std::cout << "# " << printable(sample["unit"].get<std::string>()) << ": " << state_name(info)
              << "\n---\n";
  }
}

// 0, or 2 if not all that was asked for came in time. `json_of`: of a sample.
template <class T, class JsonOf>
int echo(const EchoOptions& options, const idl::KnownTopic& topic, JsonOf json_of) {
  std::signal(SIGPIPE, SIG_IGN);  // the stream notices
  host::StopSignal stop;
  host::set_up_logging("warning");
  const idl::Participant participant(options.domain);
  idl::Reader<T> reader(participant, topic.name, topic.reader_qos());
  idl::WaitSet wait_set;
  wait_set.attach(reader.readable());
  const std::uint64_t wanted = options.once         ? 1
                               : options.count == 0 ? std::numeric_limits<std::uint64_t>::max()
                                                    : options.count;
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(options.duration_s));
  const Clock::time_point silent = Clock::now() + kSilence;
  bool told = false;
  std::uint64_t printed = 0;
  const auto on_sample = [&](const T& sample, const idl::SampleInfo& info) {
    const std::string unit = sample.unit == nullptr ? "" : sample.unit;
    if (unit.empty() || (!options.unit.empty() && unit != options.unit)) return;
    if (printed >= wanted) return;
    print(options, json_of(sample), info);
    if (info.valid) ++printed;
  };
  // A silent topic writes nothing that would show that the pipe's reader has left.
  const auto read = [] { return std::cout.good() && !host::reader_has_left(); };
  while (printed < wanted && read() && !stop.received()) {
    if (wait_set.wait(idl::kLongestWait)) reader.take_with_info(on_sample);
    std::cout.flush();
    if (printed == 0 && !told && Clock::now() >= silent) {
      std::cerr << "mpm echo: nothing has come on " << options.topic << " yet, on "
                << bus::place_text(options.domain) << '\n';
      told = true;
    }
    if (options.duration_s > 0.0 && Clock::now() >= end) break;
  }
  if (printed == 0 && read())
    std::cerr << "mpm echo: no sample of " << options.topic
              << (options.unit.empty() ? "" : " of unit " + options.unit) << " came on "
              << bus::place_text(options.domain) << '\n';
  const bool bounded = options.once || options.count > 0;
  return (bounded ? printed < wanted : options.duration_s > 0.0 && printed == 0) ? 2 : 0;
}

template <class Record>
int echo_output(const EchoOptions& options, const idl::KnownTopic& topic) {
  using Sample = idl::SampleOf<Record>;
  return echo<Sample>(options, topic, [](const Sample& sample) {
    return report::json_of(idl::record_of<Record>(sample));
  });
}

using Echo = int (*)(const EchoOptions&, const idl::KnownTopic&);

// Null where `topic` is none that the monitor writes.
template <class... Record>
Echo find_output(const idl::KnownTopic& topic, const std::tuple<Record...>*) {
  Echo found = nullptr;
  ((topic.name == std::string_view(idl::OutputTopic<Record>::kName)
        ? void(found = echo_output<Record>)
        : void()),
   ...);
  return found;
}

int echo(const EchoOptions& options) {
  const auto json_of = [](const auto& sample) { return bus::json_of(sample); };
  if (options.topic == idl::kRoleTopic) return echo<mpm_Role>(options, idl::role_topic(), json_of);
  const idl::KnownTopic* topic = idl::find_known_topic(options.topic);
  if (topic == nullptr) {
    std::cerr << "mpm echo: error: '" << options.topic
              << "' is no topic of the monitor; try mpm topics, and mpm hz for what others write\n";
    return 3;
  }
  if (const Echo output = find_output(*topic, static_cast<const idl::OutputRecords*>(nullptr)))
    return output(options, *topic);
  if (topic->type == &mpm_Layout_desc) return echo<mpm_Layout>(options, *topic, json_of);
  return echo<mpm_Sample>(options, *topic, json_of);
}

}  // namespace

void add_echo(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("echo", "print the samples of a topic");
  const auto options = std::make_shared<EchoOptions>();
  command->add_option("topic", options->topic, "mpm/mv, mpm/alarm ...")->required();
  command->add_option("--unit", options->unit, "only this unit");
  auto* once = command->add_flag("--once", options->once, "end after one sample");
  command->add_option("--count", options->count, "end after this many samples")
      ->check(cli::number_value(1.0))
      ->excludes(once);
  command->add_option("--duration", options->duration_s, "end after this time, as 90 or 1.5h")
      ->transform(positive_time_value());
  command->add_flag("--json", options->json, "print each sample as a JSON line");
  add_domain_flags(*command, options->domain);
  command->footer(
      "Examples:\n"
      "  mpm echo mpm/mv --unit shell --once\n"
      "  mpm echo mpm/alarm_event --json --duration 3600\n"
      "Exit codes: 0 done, 2 what was asked for did not come, 3 bad usage");
  command->callback([options, &exit_code] { exit_code = echo(*options); });
}

}  // namespace mpm::app
