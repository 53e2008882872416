#include "daemon/bag/info.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "config/finding.hpp"
#include "core/signal/interval_gap.hpp"
#include "core/signal/nanoseconds.hpp"
#include "core/signal/saturated.hpp"
#include "daemon/bag/contents.hpp"
#include "daemon/bag/kind_name.hpp"
#include "daemon/bag/sample_stream.hpp"
#include "daemon/files/csv/csv_rows.hpp"
#include "daemon/mcap/read/file_sequence.hpp"
#include "daemon/mcap/read/reader.hpp"
#include "daemon/mcap/read/scan.hpp"

namespace mpm::bag {
namespace {

constexpr std::size_t kFirstSteps = 1000;  // enough for their median
constexpr double kGap = 1.5;               // of the median step: at least one row is missing

std::string tag_or_place(const std::vector<std::string>& tags, SignalKind kind, std::size_t index) {
  if (index < tags.size()) return tags[index];
  return std::string(name_of(kind)) + '[' + std::to_string(index) + ']';
}

/// Takes the messages of an MCAP file one by one.
class McapInspector {
 public:
  McapInspector(FileInfo& info, const files::TimeChoice& choice) : info_(info), choice_(choice) {}

  /// Messages so far, taken or not.
  [[nodiscard]] std::uint64_t seen() const { return seen_; }

  void add(const mcap::Message& message) {
    ++seen_;
    if (!choice_.takes(message.log_time_ns)) {
      cut();
      if (message.channel->topic == idl::kLayoutTopic) add_layout(message);
      return;
    }
    cut_ = false;
    info_.times.add(message.log_time_ns);
    TopicTally& topic = info_.topics[message.channel->topic];
    topic.message_encoding = message.channel->message_encoding;
    if (message.schema != nullptr) {
      topic.type = message.schema->name;
      topic.schema_encoding = message.schema->encoding;
    }
    topic.times.add(message.log_time_ns);
    topic.bytes += message.data.size();
    if (message.channel->topic == idl::kLayoutTopic) add_layout(message);
    if (message.channel->message_encoding != "cdr") return;
    if (const std::optional<SignalKind> kind = kind_of(message.channel->topic))
      if (const mpm_Sample* sample = samples_.decode(message.data))
        add_sample(idl::view_of(*kind, *sample));
  }

  /// Layouts may come after the samples that they name.
  void finish() {
    for (auto& [name, unit] : info_.units)
      for (auto& [kind, samples] : unit.samples)
        for (std::size_t i = 0; i < samples.signals.size(); ++i)
          samples.signals[i].tag = tag_or_place(tags_[{name, kind}], kind, i);
  }

 private:
  UnitTally* unit_of(std::string_view name) {
    const std::string key(name);
    if (info_.units.size() >= kMostUnits && info_.units.find(key) == info_.units.end())
      return nullptr;
    return &info_.units[key];
  }

  /// Where messages are left out on purpose, no sample is missing.
  void cut() {
    if (std::exchange(cut_, true)) return;
    for (auto& [name, unit] : info_.units)
      for (auto& [kind, samples] : unit.samples) samples.cut = true;
  }

  /// Whenever it came, it names what was taken.
  void add_layout(const mcap::Message& message) {
    if (message.channel->message_encoding != "cdr") return;
    if (const mpm_Layout* layout = layouts_.decode(message.data)) add_layout(*layout);
  }

  void add_layout(const mpm_Layout& layout) {
    if (layout.unit == nullptr || layout.kind == nullptr) return;
    UnitTally* unit = unit_of(layout.unit);
    if (unit == nullptr) return;
    unit->sample_time_s = layout.sample_time_s;
    for (std::size_t k = 0; k < kSignalKindCount; ++k) {
      const auto kind = static_cast<SignalKind>(k);
      if (std::string_view(layout.kind) != name_of(kind)) continue;
      std::vector<std::string>& tags = tags_[{layout.unit, kind}];
      tags.clear();
      for (std::uint32_t i = 0; i < layout.tags._length; ++i)
        tags.emplace_back(layout.tags._buffer[i] == nullptr ? "" : layout.tags._buffer[i]);
    }
  }

  void add_sample(const idl::SampleView& sample) {
    UnitTally* unit = unit_of(sample.unit);
    if (unit == nullptr) return;
    SampleTally& tally = unit->samples[sample.kind];
    tally.kind = sample.kind;
    const std::int64_t step = saturated_difference(sample.interval, tally.last_interval);
    const std::uint64_t missing = missing_between(tally.last_interval, sample.interval);
    if (tally.times.count > 0 && missing > 0 && !tally.cut)
      tally.times.add_gap(tally.last_ns, sample.source_time_ns, missing);
    tally.cut = false;
    if (tally.times.count == 0 || step > 0 || step < -kRestart) {
      tally.last_interval = sample.interval;
      tally.last_ns = sample.source_time_ns;
    }
    tally.times.add(sample.source_time_ns);
    if (tally.signals.size() < sample.values.size()) tally.signals.resize(sample.values.size());
    for (std::size_t i = 0; i < sample.values.size(); ++i) {
      const std::uint8_t code = i < sample.quality.size() ? sample.quality[i] : 0;
      tally.signals[i].add(sample.values[i], code > 2 ? Quality::kBad : Quality{code});
    }
  }

  static constexpr std::int64_t kRestart = 1000;  // intervals back: not out of order, a new count

  FileInfo& info_;
  const files::TimeChoice& choice_;
  std::uint64_t seen_ = 0;
  bool cut_ = false;  ///< the last message was not taken
  idl::CdrDecoder<mpm_Sample> samples_;
  idl::CdrDecoder<mpm_Layout> layouts_;
  std::map<std::pair<std::string, SignalKind>, std::vector<std::string>> tags_;
};

void inspect_file(const std::string& path, McapInspector& inspector, FileInfo& info) {
  mcap::Reader reader(path);
  // Of several files, which one is meant.
  const std::string prefix = info.files.size() > 1 ? path + ": " : "";
  const std::uint64_t before = inspector.seen();
  try {
    mcap::Message message;
    while (reader.next(message)) inspector.add(message);
  } catch (const config::InputError& error) {
    if (info.problem.empty())
      info.problem = prefix + error.finding().key + ": " + error.finding().message;
  }
  info.library = reader.library();
  info.profile = reader.profile();

  mcap::InputFile file(path);
  const mcap::FileLayout layout = mcap::scan(file);
  info.chunks += layout.chunks.size();
  info.packed_bytes += layout.packed_bytes;
  info.unpacked_bytes += layout.unpacked_bytes;
  info.compressions.insert(layout.compressions.begin(), layout.compressions.end());
  const std::string problem = layout.damage
                                  ? "the file has no end"
                                  : mcap::index_problem(file, layout, inspector.seen() - before);
  if (info.index_problem.empty() && !problem.empty()) info.index_problem = prefix + problem;
}

/// Log time of the first message; that of a file without any does not matter.
std::int64_t start_ns(const std::string& path) {
  mcap::Reader reader(path);
  mcap::Message message;
  try {
    return reader.next(message) ? message.log_time_ns : 0;
  } catch (const config::InputError&) {  // torn before its first message
    return 0;
  }
}

// Not by mcap::FileSequence, which refuses what is torn.
void inspect_mcap(const std::vector<std::string>& paths, const files::TimeChoice& choice,
                  FileInfo& info) {
  std::vector<std::pair<std::int64_t, std::string>> starts;
  for (const std::string& file : mcap::recording_files(paths))
    starts.emplace_back(start_ns(file), file);
  std::stable_sort(starts.begin(), starts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [start, file] : starts) info.files.push_back(file);
  McapInspector inspector(info, choice);
  for (const std::string& file : info.files) inspect_file(file, inspector, info);
  inspector.finish();
}

/// Steps between rows: the first ones are kept until their median is known.
class RowClock {
 public:
  explicit RowClock(FileInfo& info) : info_(info) {}

  /// `cut`: rows before it were left out on purpose.
  void add(std::int64_t time_ns, bool cut) {
    if (cut) {
      last_ns_ = time_ns;
    } else if (info_.times.count > 0 && time_ns > last_ns_) {
      if (step_ns_ == 0.0) {
        steps_.emplace_back(last_ns_, time_ns);
        if (steps_.size() == kFirstSteps) settle();
      } else {
        judge(last_ns_, time_ns);
      }
    } else if (info_.times.count > 0) {
      info_.times.add_step_back(last_ns_, time_ns);
    }
    last_ns_ = time_ns;
    info_.times.add(time_ns);
  }

  void settle() {
    if (steps_.empty()) return;
    std::vector<std::int64_t> sizes;
    for (const auto& [before, after] : steps_) sizes.push_back(after - before);
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    step_ns_ = static_cast<double>(*middle);
    info_.step_s = step_ns_ / kNsPerSecond;
    for (const auto& [before, after] : steps_) judge(before, after);
    steps_.clear();
  }

 private:
  void judge(std::int64_t before_ns, std::int64_t after_ns) {
    const double steps = static_cast<double>(after_ns - before_ns) / step_ns_;
    if (steps > kGap)
      info_.times.add_gap(before_ns, after_ns, static_cast<std::uint64_t>(std::llround(steps)) - 1);
  }

  FileInfo& info_;
  std::vector<std::pair<std::int64_t, std::int64_t>> steps_;
  std::int64_t last_ns_ = 0;
  double step_ns_ = 0.0;
};

void inspect_csv(FileInfo& info, const files::TimeStyle& times, const files::TimeChoice& choice) {
  files::CsvRows rows(info.path, times);
  info.layout = rows.layout();
  info.delimiter = rows.delimiter();
  for (const files::Column& column : rows.columns()) {
    info.signals.emplace_back();
    info.signals.back().tag = column.tag;
  }
  RowClock clock(info);
  Frame frame;
  bool cut = false;
  while (rows.next(frame)) {
    if (!choice.takes(frame.source_time_ns)) {
      cut = true;
      continue;
    }
    clock.add(frame.source_time_ns, std::exchange(cut, false));
    const SignalBlock& block = frame[SignalKind::kAux];
    for (std::size_t i = 0; i < info.signals.size(); ++i)
      info.signals[i].add(block.values(static_cast<Eigen::Index>(i)), block.quality[i]);
  }
  clock.settle();
  info.notices = rows.notices();
}

}  // namespace

void SignalTally::add(double value, Quality quality) {
  if (!std::isfinite(value))
    ++missing;
  else if (quality == Quality::kGood)
    ++good;
  else if (quality == Quality::kUncertain)
    ++uncertain;
  else
    ++bad;
}

void TimeTally::add(std::int64_t time_ns) {
  first_ns = count == 0 ? time_ns : std::min(first_ns, time_ns);
  last_ns = count == 0 ? time_ns : std::max(last_ns, time_ns);
  ++count;
}

void TimeTally::add_gap(std::int64_t before_ns, std::int64_t after_ns, std::uint64_t intervals) {
  ++gaps;
  missing += intervals;
  const std::int64_t length_ns = saturated_difference(after_ns, before_ns);
  if (length_ns <= longest_gap_ns) return;
  longest_gap_ns = length_ns;
  longest_gap_at_ns = before_ns;
}

void TimeTally::add_step_back(std::int64_t before_ns, std::int64_t after_ns) {
  const std::int64_t back_ns = saturated_difference(before_ns, after_ns);
  if (out_of_order++ > 0 && back_ns <= farthest_back_ns) return;
  farthest_back_ns = back_ns;
  farthest_back_at_ns = before_ns;
}

double TimeTally::rate_hz() const {
  const double span_s = static_cast<double>(saturated_difference(last_ns, first_ns)) / kNsPerSecond;
  return count > 1 && span_s > 0.0 ? static_cast<double>(count - 1) / span_s : 0.0;
}

FileInfo inspect(const std::vector<std::string>& paths, const files::TimeStyle& times,
                 const files::TimeChoice& choice) {
  FileInfo info;
  info.path = mcap::name_of(paths);
  info.is_mcap = mcap::is_recording(paths);
  if (info.is_mcap)
    inspect_mcap(paths, choice, info);
  else
    inspect_csv(info, times, choice);
  if (info.times.count == 0 && !choice.all() && info.problem.empty())
    throw config::InputError({info.path, 0, 0, config::Severity::kError, "",
                              "--from, --until and --exclude leave nothing of it"});
  std::error_code ignored;
  for (const std::string& file : info.is_mcap ? info.files : paths)
    info.bytes += std::filesystem::file_size(file, ignored);
  return info;
}

FileInfo inspect(const std::string& path, const files::TimeStyle& times) {
  return inspect(std::vector{path}, times);
}

}  // namespace mpm::bag
