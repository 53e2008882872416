#include "core/signal/nanoseconds.hpp"
#include "daemon/app/commands/commands.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "config/cli/number_value.hpp"
#include "config/finding.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/app/commands/status_line.hpp"
#include "daemon/app/commands/topic_choice_options.hpp"
#include "daemon/bag/replay/keyboard.hpp"
#include "daemon/bag/replay/mcap_source.hpp"
#include "daemon/bag/replay/player.hpp"
#include "daemon/bag/replay/selection.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "idl/raw_writer.hpp"

namespace mpm::app {
namespace {

using Steady = std::chrono::steady_clock;
using Writers = std::map<std::string, idl::RawWriter>;

constexpr std::chrono::milliseconds kMatchPoll{5};
constexpr std::chrono::milliseconds kGreetTime{200};

struct ReplayOptions {
  std::vector<std::string> files;
  bag::TopicChoice topics;
  std::vector<std::string> remap;
  idl::DomainOptions domain;
  bag::PlayerOptions player;
  double start_offset_s = 0.0;
  double duration_s = 0.0;
  double delay_s = 0.0;
  std::string until;
  double wait_readers_s = 10.0;
  int readers = 1;
};

/// Throws std::invalid_argument.
std::map<std::string, std::string> parse_remap(const std::vector<std::string>& rules) {
  std::map<std::string, std::string> remap;
  for (const std::string& rule : rules) {
    const std::size_t at = rule.find(":=");
    if (at == std::string::npos || at == 0 || at + 2 == rule.size())
      throw std::invalid_argument("--remap: '" + rule + "' is not FROM:=TO");
    if (const std::string to = rule.substr(at + 2); printable(to) != to)
      throw std::invalid_argument("--remap: '" + printable(to) +
                                  "' has what no unit is named with: a control character, bytes "
                                  "that are no UTF-8, or too many");
    if (!remap.emplace(rule.substr(0, at), rule.substr(at + 2)).second)
      throw std::invalid_argument("--remap: two rules for unit '" + rule.substr(0, at) + "'");
  }
  return remap;
}

/// `--topics T... FILE` takes FILE for a topic.
void find_swallowed_files(ReplayOptions& options) {
  std::vector<std::string>& topics = options.topics.names;
  const auto is_file = [](const std::string& text) {
    return idl::find_known_topic(text) == nullptr && std::filesystem::exists(text);
  };
  const auto files = std::stable_partition(topics.begin(), topics.end(),
                                           [&](const auto& text) { return !is_file(text); });
  options.files.insert(options.files.end(), files, topics.end());
  topics.erase(files, topics.end());
}

/// Throws std::invalid_argument.
std::set<std::string> topics_of(const ReplayOptions& options) {
  for (const std::string& topic : options.topics.names)
    if (idl::find_known_topic(topic) == nullptr)
      throw std::invalid_argument("--topics: '" + topic +
                                  "' is no topic of the monitor (write files before the options)");
  std::vector<std::string> inputs;
  for (const idl::KnownTopic& topic : idl::known_topics())
    if (topic.input) inputs.emplace_back(topic.name);
  return bag::chosen_topics(options.topics, inputs);
}

/// `text`: a time since the recording's beginning, or a moment. Throws std::invalid_argument.
void set_end(std::string text, bag::PlayerOptions& player) {
  if (text.empty()) return;
  std::string problem;
  if (const std::string moment = text; positive_time_value()(text).empty())
    player.end_offset_ns = static_cast<std::int64_t>(std::stod(text) * kNsPerSecond);
  else if (!(player.end_ns = files::parse_time(moment, problem)))
    throw std::invalid_argument("--playback-until: '" + moment +
                                "' is neither a time above 0, as 90 or 1.5h, nor a moment, as "
                                "2026-01-31T12:00:00Z");
}

// What is sent before a reader and its writer know each other is lost.
void wait_for_readers(const Writers& writers, const ReplayOptions& options,
                      host::StopSignal& stop) {
  if (options.wait_readers_s <= 0.0) return;
  const Steady::time_point end =
      Steady::now() + std::chrono::duration_cast<Steady::duration>(
                          std::chrono::duration<double>(options.wait_readers_s));
  for (const auto& [topic, writer] : writers) {
    while (writer.matched_readers() < options.readers && Steady::now() < end && !stop.received())
      std::this_thread::sleep_for(kMatchPoll);
    bool known = false;
    while (writer.matched_readers() > 0 && !known && Steady::now() < end && !stop.received())
      known = writer.greet(kGreetTime);
    if (!known && !stop.received())
      std::cerr << "mpm replay: " << topic << " has "
                << (writer.matched_readers() == 0 ? "no reader" : "too few readers") << " after "
                << options.wait_readers_s << " s; going on all the same\n";
  }
}

std::string progress_text(const bag::PlayerState& state, std::int64_t length_ns) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "%.1f",
                static_cast<double>(state.recorded_ns) / kNsPerSecond);
  std::string line = text.data();
  if (length_ns > 0) {
    std::snprintf(text.data(), text.size(), " of %.1f",
                  static_cast<double>(length_ns) / kNsPerSecond);
    line += text.data();
  }
  line += " s  " + counted(state.samples, "sample") + "  ";
  if (state.rate == 0.0) {
    line += "as fast as readers keep up";
  } else {
    std::snprintf(text.data(), text.size(), "%g x", state.rate);
    line += text.data();
  }
  if (state.passes > 0) line += "  pass " + std::to_string(state.passes + 1);
  if (state.paused) line += "  paused";
  return line;
}

/// Refuses what the recording calls a sample and is none.
bool send(const Writers& writers, const bag::McapSource& source, const bag::ReplaySample& sample,
          std::int64_t source_time_ns, const idl::SampleChange& change) {
  const auto writer = writers.find(sample.topic);
  if (writer == writers.end()) return true;
  const idl::WriteResult result =
      sample.state == idl::InstanceState::kAlive
          ? writer->second.write(sample.cdr, source_time_ns, change)
          : writer->second.end_instance(sample.cdr, sample.state, source_time_ns, change);
  if (result == idl::WriteResult::kNotCdr)
    throw config::InputError({source.file(), 0, 0, config::Severity::kError, "",
                              "holds a message of " + sample.topic + " that is no sample of it"});
  return result == idl::WriteResult::kWritten;
}

int replay(const ReplayOptions& options, host::StopSignal& stop) {
  if (options.files.empty()) throw std::invalid_argument("which recording? Give a file or folder");
  bag::McapSource source(options.files, topics_of(options));
  bag::PlayerOptions player_options = options.player;
  player_options.remap = parse_remap(options.remap);
  player_options.start_offset_ns = static_cast<std::int64_t>(options.start_offset_s * kNsPerSecond);
  player_options.duration_ns = static_cast<std::int64_t>(options.duration_s * kNsPerSecond);
  player_options.delay_ns = static_cast<std::int64_t>(options.delay_s * kNsPerSecond);
  set_end(options.until, player_options);
  bag::check_selection(source, player_options);
  for (const std::string& topic : options.topics.names)
    if (source.topics().count(topic) == 0)
      std::cerr << "mpm replay: the recording has no " << topic << '\n';
  bag::Keyboard keyboard;
  if (player_options.start_paused && !keyboard.there())
    throw std::invalid_argument("--start-paused: there is no terminal, so nobody could start it");

  const idl::Participant participant(options.domain);
  Writers writers;
  for (const std::string& topic : source.topics())
    writers.emplace(topic, idl::RawWriter(participant, *idl::find_known_topic(topic),
                                          idl::WriterPace::kLossless));
  wait_for_readers(writers, options, stop);

  host::SteadyClock clock;
  StatusLine status;
  if (keyboard.there()) status.say("space pause, s or right step, + and - speed, q quit");
  bag::Player player(
      source, clock, player_options,
      [&](const bag::ReplaySample& sample, std::int64_t time_ns, const idl::SampleChange& change) {
        return send(writers, source, sample, time_ns, change);
      },
      [&](const bag::PlayerState& state) {
        if (status.due(Steady::now())) status.show(progress_text(state, source.length_ns()));
        return stop.received() ? bag::Key::kQuit : keyboard.next();
      });
  const bool sent = player.play();
  bool taken = sent;
  for (const auto& [topic, writer] : writers) taken = taken && writer.flush(kFlushTime);
  status.say("mpm replay: " + counted(player.state().samples, "sample") + " published");
  if (!sent) throw std::runtime_error("a reader does not take samples");
  if (!taken) status.say("mpm replay: some readers do not have all samples");
  return 0;
}

int replay(ReplayOptions options) {
  find_swallowed_files(options);
  host::StopSignal stop;  // before any thread
  host::set_up_logging("warning");
  try {
    return replay(options, stop);
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  } catch (const std::invalid_argument& error) {
    std::cerr << "mpm replay: error: " << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("replay", "publish recordings again, as they were");
  const auto options = std::make_shared<ReplayOptions>();
  bag::PlayerOptions& player = options->player;
  command->add_option("files", options->files, "recordings (*.mcap), or folders of them");
  command
      ->add_option("-r,--rate", player.rate,
                   "recorded time per time; 0 = as fast as readers keep up")
      ->capture_default_str()
      ->check(cli::number_value(0.0));
  command
      ->add_option("--start-offset", options->start_offset_s,
                   "leave out this much at the beginning, as 90 or 1.5h (s, min, h, d)")
      ->transform(time_value());
  command->add_option("--duration", options->duration_s, "end after this much recorded time")
      ->transform(positive_time_value());
  command->add_option("--playback-until", options->until,
                      "end there: recorded time since the beginning, as 90 or 1.5h, or a moment, "
                      "as 2026-01-31T12:00:00Z");
  command
      ->add_option("--delay", options->delay_s,
                   "wait this long before the first sample, in a loop before each pass")
      ->transform(time_value());
  command->add_flag("-l,--loop", player.loop,
                    "begin again at the end; interval numbers and times go on");
  command->add_flag("-p,--start-paused", player.start_paused, "wait for the space bar");
  add_topic_choice(*command, options->topics,
                   "these topics, as mpm/mv,mpm/cv (default: the inputs, so that a monitor "
                   "judges anew)");
  command->add_option("--unit", player.unit, "only this unit");
  command->add_option("--remap", options->remap, "publish unit FROM as TO: FROM:=TO; repeatable")
      ->allow_extra_args(false);  // what follows is a file
  command
      ->add_option("--wait-readers", options->wait_readers_s,
                   "how long to wait for a reader of every topic before the first sample")
      ->capture_default_str()
      ->transform(time_value());
  command->add_option("--readers", options->readers, "how many readers of every topic to wait for")
      ->capture_default_str()
      ->check(cli::number_value(1.0));
  options->domain.role = "gateway";
  add_domain_flags(*command, options->domain);
  command->footer(
      "Keys: space pause, s or right arrow step, + and - or up and down speed, q quit\n"
      "Examples:\n"
      "  mpm replay monday.mcap --rate 10\n"
      "  mpm replay recordings/ --rate 0 --remap shell:=shell_copy\n"
      "Exit codes: 0 done, 2 failed, 3 bad usage or a file that is no recording");
  command->callback([options, &exit_code] { exit_code = replay(*options); });
}

}  // namespace mpm::app
