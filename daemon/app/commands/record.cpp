#include "core/signal/nanoseconds.hpp"
#include "daemon/app/commands/commands.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "core/text/number_text.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/app/commands/status_line.hpp"
#include "daemon/app/commands/topic_choice_options.hpp"
#include "daemon/bag/record/recorder.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "idl/topic_catalog.hpp"
#include "idl/topics.hpp"
#include "idl/wait_set.hpp"

namespace mpm::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kSearchPeriod{1};

// The schemas of all topics take 16 kB of every file, twice.
constexpr std::uint64_t kSmallestFile = 100'000;
constexpr std::uint64_t kSmallestQuota = 1'000'000;
constexpr std::uint64_t kSmallestChunk = 1024, kLargestChunk = std::uint64_t{64} << 20U;

// What snapshots take by default: hours of a fast unit.
constexpr std::uint64_t kRingQuota = 10'000'000'000, kSavedQuota = 20'000'000'000;

struct SnapshotFlags {
  bool wanted = false;
  double before_s = 7200.0, after_s = 1800.0;
  std::uint64_t quota_bytes = kSavedQuota;
  std::string when_full = "stop";
};

struct RecordOptions {
  idl::DomainOptions domain;
  bag::RecorderOptions recorder;
  bag::TopicChoice topics;
  SnapshotFlags snapshots;
  std::uint64_t chunk_bytes = 1U << 20U;
  double chunk_age_s = 1.0;
  double max_duration_s = 0.0;
  double duration_s = 0.0;  // 0 = until interrupted
  std::string compression = "zstd";
};

mcap::Compression compression_of(const std::string& name) {
  return name == "none" ? mcap::Compression::kNone : mcap::Compression::kZstd;
}

std::string seconds_text(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", seconds);
  return text.data();
}

/// Rates over the time since the last line.
class Rates {
 public:
  std::string text(const bag::RecorderState& state, Clock::time_point now) {
    const double seconds = std::chrono::duration<double>(now - last_).count();
    const double samples = static_cast<double>(state.totals.samples - samples_) / seconds;
    const double bytes = static_cast<double>(state.totals.bytes - bytes_) / seconds;
    last_ = now;
    samples_ = state.totals.samples;
    bytes_ = state.totals.bytes;
    std::array<char, 64> rate{};
    std::snprintf(rate.data(), rate.size(), "%.0f/s", samples);
    return summary(state) + "; now " + rate.data() + ", " + bytes_text(bytes) + "/s";
  }
  [[nodiscard]] std::string summary(const bag::RecorderState& state) const {
    const bag::RecordingTotals& totals = state.totals;
    std::string text = seconds_text(std::chrono::duration<double>(Clock::now() - start_).count());
    text += "  " + counted(totals.samples, "sample") + "  " +
            bytes_text(static_cast<double>(totals.bytes)) + "  " + std::to_string(state.dropped) +
            " dropped";
    if (state.refused > 0) text += "  " + std::to_string(state.refused) + " refused";
    if (state.lost > 0) text += "  " + std::to_string(state.lost) + " lost by DDS";
    if (totals.missing_intervals > 0)
      text += "  " + counted(totals.missing_intervals, "interval") + " missing";
    if (totals.files > 1) text += "  " + std::to_string(totals.files) + " files";
    if (totals.deleted > 0) text += ", " + std::to_string(totals.deleted) + " deleted";
    return text;
  }

 private:
  Clock::time_point start_ = Clock::now(), last_ = start_;
  std::uint64_t samples_ = 0, bytes_ = 0;
};

void tell_news(bag::Recorder& recorder, StatusLine& status) {
  for (const std::string& news : recorder.take_news()) status.say("mpm record: " + news);
}

int record(const RecordOptions& options, host::StopSignal& stop, host::AwaitedSignal* save) {
  const idl::Participant participant(options.domain);
  bag::Recorder recorder(participant, options.recorder);
  StatusLine status;
  status.say("mpm record: recording to " + recorder.state().path);
  Rates rates;
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(options.duration_s));
  Clock::time_point next_search{};
  std::string problem, path = recorder.state().path;
  while (!stop.received() && problem.empty()) {
    recorder.poll(idl::kLongestWait);
    if (save != nullptr && save->take()) recorder.save();
    tell_news(recorder, status);
    const Clock::time_point now = Clock::now();
    if (options.duration_s > 0.0 && now >= end) break;
    if (now >= next_search) {
      recorder.look_around();
      problem = recorder.state().problem;
      next_search = now + kSearchPeriod;
    }
    if (!status.due(now)) continue;
    const bag::RecorderState state = recorder.state();
    if (state.path != path) status.say("mpm record: going on in " + (path = state.path));
    status.show(rates.text(state, now));
  }
  recorder.finish();
  tell_news(recorder, status);
  const bag::RecorderState state = recorder.state();
  status.say("mpm record: " + rates.summary(state) + "  " + state.path);
  const std::string& unit = options.recorder.unit;
  if (state.totals.samples == 0 && state.dropped == 0)
    status.say("mpm record: no sample " + (unit.empty() ? "" : "of unit " + unit + " ") +
               "came on " + bus::place_text(options.domain));
  for (const std::string& topic : recorder.not_found())
    status.say("mpm record: nobody wrote " + topic + ", or not with a type that can be asked for");
  if (state.problem.empty()) return 0;
  std::cerr << "mpm record: error: " << state.problem << '\n';
  return 2;
}

std::int64_t ns(double seconds) { return static_cast<std::int64_t>(seconds * kNsPerSecond); }

/// Throws std::invalid_argument.
void set_snapshots(const SnapshotFlags& flags, bag::RecorderOptions& recorder) {
  const std::filesystem::path output(recorder.recording.output);
  if (output.extension() == ".mcap" && !std::filesystem::is_directory(output))
    throw std::invalid_argument("--snapshot: --output has to be a folder");
  const std::vector<std::string>& topics = recorder.topics;
  if (std::find(topics.begin(), topics.end(), idl::kAlarmEventTopic) == topics.end())
    throw std::invalid_argument(std::string("--snapshot looks for alarms, and ") +
                                idl::kAlarmEventTopic + " is not among the topics");
  bag::RecordingOptions& recording = recorder.recording;
  if (recording.quota_bytes == 0)
    recording.quota_bytes = std::max(kRingQuota, 8 * recording.max_size_bytes);
  recording.snapshots = {ns(flags.before_s), ns(flags.after_s), flags.quota_bytes,
                         flags.when_full == "drop-oldest"};
}

/// Throws std::invalid_argument.
void settle(RecordOptions& options) {
  bag::RecordingOptions& recording = options.recorder.recording;
  if (recording.quota_bytes > 0 && recording.max_size_bytes > recording.quota_bytes / 2)
    throw std::invalid_argument(
        "--quota must hold two files of --max-size at least: one that is full and the next");
  recording.max_duration_ns = ns(options.max_duration_s);
  recording.file.compression = compression_of(options.compression);
  recording.file.chunk_bytes = options.chunk_bytes;
  recording.file.chunk_age_ns = ns(options.chunk_age_s);
  std::vector<std::string> ours;
  for (const idl::KnownTopic& topic : idl::known_topics()) ours.emplace_back(topic.name);
  const std::set<std::string> topics = bag::chosen_topics(options.topics, ours);
  options.recorder.topics.assign(topics.begin(), topics.end());
  if (options.snapshots.wanted) set_snapshots(options.snapshots, options.recorder);
}

int record(RecordOptions options) {
  host::StopSignal stop;  // before any thread
  std::optional<host::AwaitedSignal> save;
  if (options.snapshots.wanted) save.emplace(std::initializer_list<int>{SIGUSR1});
  host::set_up_logging("warning");
  try {
    settle(options);
    return record(options, stop, save ? &*save : nullptr);
  } catch (const std::invalid_argument& error) {
    std::cerr << "mpm record: error: " << error.what() << '\n';
    return 3;
  }
}

void add_snapshot_options(CLI::App& command, SnapshotFlags& flags) {
  constexpr std::uint64_t kSmallestSaved = 1'000'000;
  CLI::Option* wanted = command.add_flag(
      "--snapshot", flags.wanted,
      "keep the last hours only, in the folder --output, and save those around an alarm in its "
      "folder saved/; SIGUSR1 saves them now. Without --quota the last hours take 10 GB at most");
  const auto add = [&](const char* name, auto& value, const char* description) {
    return command.add_option(name, value, description)->capture_default_str()->needs(wanted);
  };
  add("--snapshot-before", flags.before_s, "saved before the alarm, as 90 or 1.5h")
      ->transform(time_value())
      ->check(CLI::Range(10.0, 1e7));
  add("--snapshot-after", flags.after_s, "saved after the alarm")
      ->transform(time_value())
      ->check(CLI::Range(1.0, 1e7));
  add("--snapshot-quota", flags.quota_bytes, "no snapshot begins once the saved ones take this")
      ->transform(size_value(kSmallestSaved));
  add("--snapshot-full", flags.when_full, "what then: save no more, or delete the oldest saved one")
      ->check(CLI::IsMember({"stop", "drop-oldest"}));
}

}  // namespace

void add_record(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("record", "record what goes over the bus (MCAP)");
  const auto options = std::make_shared<RecordOptions>();
  bag::RecorderOptions& recorder = options->recorder;
  auto* unit = command->add_option("--unit", recorder.unit, "only this unit (default: all)");
  add_topic_choice(*command, options->topics, "only these topics (default: all of mpm/*)");
  command->add_option("-o,--output", recorder.recording.output, "file.mcap, or a folder")
      ->required();
  command
      ->add_option("--max-size", recorder.recording.max_size_bytes,
                   "begin another file after this much, as 100MB or 1.5GB; at least 100 kB, since "
                   "every file holds all types")
      ->transform(size_value(kSmallestFile));
  command
      ->add_option("--max-duration", options->max_duration_s,
                   "begin another file after this time, as 90 or 1.5h (s, min, h, d)")
      ->transform(positive_time_value());
  command
      ->add_option("--quota", recorder.recording.quota_bytes,
                   "delete the oldest of the recording's files beyond this, as 10GB; at least 1 MB "
                   "and two files of --max-size")
      ->transform(size_value(kSmallestQuota));
  command->add_option("--chunk-size", options->chunk_bytes, "of the file's chunks")
      ->transform(size_value(kSmallestChunk))
      ->check(CLI::Range(kSmallestChunk, kLargestChunk));
  command
      ->add_option("--chunk-duration", options->chunk_age_s,
                   "at most this much is lost if the recorder is killed")
      ->capture_default_str()
      ->transform(time_value())
      ->check(CLI::Range(0.01, 3600.0));
  command->add_option("--compression", options->compression, "of the file's chunks")
      ->capture_default_str()
      ->check(CLI::IsMember({"zstd", "none"}));
  command->add_option("--duration", options->duration_s, "end after this time, as 90 or 1.5h")
      ->transform(positive_time_value());
  add_snapshot_options(*command, options->snapshots);
  add_domain_flags(*command, options->domain,
                   [&recorder](const config::UnitConfig& of) { recorder.unit = of.unit; })
      ->description("unit file: this unit, on its domain")
      ->excludes(unit);
  command->footer(
      "Examples:\n"
      "  mpm record --config shell.yaml --output monday.mcap\n"
      "  mpm record --output /var/lib/mpm/recordings --max-duration 1h --quota 20GB\n"
      "  mpm record --output /var/lib/mpm/ring --snapshot --snapshot-before 4h\n"
      "Exit codes: 0 done, 2 failed (the disk is full, say), 3 bad usage or bad unit file");
  command->callback([options, &exit_code] { exit_code = record(*options); });
}

}  // namespace mpm::app
