#include "daemon/app/commands/given_data.hpp"

#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/text/number_text.hpp"
#include "daemon/bag/open_recording.hpp"
#include "daemon/files/read_recording.hpp"
#include "daemon/report/condensing/condensing_report.hpp"
#include "daemon/report/left_out_text.hpp"
#include "daemon/report/unit_reading.hpp"
#include "daemon/report/worst_tags.hpp"

namespace mpm::app {
namespace {

/// The frames of another source; on their way those that `choice` takes are tallied.
class TalliedFrames : public files::FrameSource {
 public:
  TalliedFrames(files::FrameSource& frames, const config::UnitConfig& unit,
                const files::TimeChoice& choice, report::PerformanceTally& performance)
      : frames_(frames), choice_(choice), reading_(unit), performance_(performance) {
    performance_.begin_run();
  }

  [[nodiscard]] bool next(Frame& frame) override {
    if (!frames_.next(frame)) return false;
    if (choice_.takes(frame.source_time_ns)) performance_.push(frame, reading_.push(frame));
    return true;
  }
  [[nodiscard]] const std::vector<std::string>& notices() const override {
    return frames_.notices();
  }

 private:
  files::FrameSource& frames_;
  const files::TimeChoice& choice_;
  report::UnitReading reading_;
  report::PerformanceTally& performance_;
};

Recording read(const std::string& file, const config::UnitConfig& unit,
               const files::TimeStyle& times, const files::TimeChoice& choice,
               std::vector<std::string>& notices, report::PerformanceTally* performance) {
  const std::unique_ptr<files::FrameSource> frames = bag::open_recording(file, unit, times);
  std::optional<TalliedFrames> tallied;
  if (performance != nullptr) tallied.emplace(*frames, unit, choice, *performance);
  files::FrameSource& source = tallied ? *tallied : *frames;
  files::RecordingFile data = files::read_recording(source, unit, file, choice);
  const std::string prefix = file + ": ";
  for (const std::string& notice : frames->notices()) notices.push_back(prefix + notice);
  const auto count = [&](std::int64_t number, const char* what, const std::string& rest) {
    if (number > 0)
      notices.push_back(prefix + counted(static_cast<std::uint64_t>(number), what) + rest);
  };
  count(data.missing, "interval", " without a row");
  count(data.long_gaps, "gap",
        " of more than " + std::to_string(data.longest_gap) +
            " intervals; a new run begins after each");
  count(data.out_of_order, "row", " left out, for the time does not grow");
  count(data.bad_values, "value",
        " of inputs and CVs missing or bad" + report::worst_tags(data.bad_tags));
  for (const std::string& text : report::left_out_texts(unit, data))
    notices.push_back(prefix + text);
  return std::move(data.recording);
}

}  // namespace

Given read_given(const std::vector<std::string>& files, const config::UnitConfig& unit,
                 const files::TimeStyle& times, const files::TimeChoice& choice,
                 std::vector<std::string>& notices, report::PerformanceTally* performance) {
  std::vector<Recording> recordings;
  Given all;
  for (const std::string& file : files) {
    recordings.push_back(read(file, unit, times, choice, notices, performance));
    all.files.insert(all.files.end(), runs_of(recordings.back()).size(), file);
    all.name += (all.name.empty() ? "" : ", ") + file;
  }
  all.recording = joined(recordings);
  return all;
}

Condensing condense(Given& given, Eigen::Index every, std::vector<std::string>& notices) {
  const Recording& all = given.recording;
  Condensed some = condensed(all, every, rows_to_diagnose(all.samples()));
  std::vector<std::string> files;
  for (const std::size_t run : some.run_of) files.push_back(given.files.at(run));
  given.recording = std::move(some.recording);
  given.files = std::move(files);
  if (some.how.any())
    notices.push_back(given.name + ": " +
                      report::condensing_text(some.how, given.recording.samples()));
  return some.how;
}

std::string command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string text;
  for (std::string word; std::getline(in, word, '\0');) {
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n\"'\\$&|;<>()*?[]#~`!{}") == std::string::npos;
    if (!text.empty()) text += ' ';
    if (plain) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char letter : word)
      text += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    text += '\'';
  }
  return text;
}

}  // namespace mpm::app
