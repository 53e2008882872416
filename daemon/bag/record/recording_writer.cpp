#include "daemon/bag/record/recording_writer.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/signal/interval_gap.hpp"
#include "core/signal/saturated.hpp"
#include "core/text/printable.hpp"
#include "daemon/bag/info_text.hpp"
#include "daemon/bag/lifecycle.hpp"
#include "idl/topics.hpp"

namespace mpm::bag {
namespace {

// With a quota and no size for one file: so many files share it, and the oldest can go.
constexpr std::uint64_t kFilesPerQuota = 8;

// A file is split behind a chunk, so its chunks must be small against it.
constexpr std::uint64_t kChunksPerFile = 4;
constexpr std::uint64_t kSmallestChunk = 4096;

// With snapshots: so many files span the time before an alarm, and the oldest can go.
constexpr std::int64_t kFilesPerSnapshot = 8;

// Layouts of all units together, with what keeping one takes beside its bytes. A hundred units of a
// hundred tags each take half a megabyte.
constexpr std::size_t kMostRepeatedBytes = 16'000'000, kBytesPerRepeated = 500;

// Whose gaps are counted: more than a plant has, so that names made up fill no memory.
constexpr std::size_t kMostUnitNames = 16'384;

RecordingOptions with_limits(RecordingOptions options) {
  options.file.must_be_new = true;
  if (options.quota_bytes > 0 && options.max_size_bytes == 0)
    options.max_size_bytes = std::max<std::uint64_t>(options.quota_bytes / kFilesPerQuota, 1);
  if (options.snapshots.before_ns > 0 && options.max_duration_ns == 0)
    options.max_duration_ns = std::max<std::int64_t>(
        options.snapshots.before_ns / kFilesPerSnapshot, options.file.chunk_age_ns);
  if (options.max_size_bytes > 0)
    options.file.chunk_bytes =
        std::min<std::size_t>(options.file.chunk_bytes,
                              std::max(options.max_size_bytes / kChunksPerFile, kSmallestChunk));
  return options;
}

mcap::ByteView bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

RecordingWriter::RecordingWriter(const RecordingOptions& options, std::int64_t now_ns)
    : options_(with_limits(options)),
      files_(options_.output, options_.max_size_bytes > 0 || options_.max_duration_ns > 0,
             options_.quota_bytes, now_ns, options_.snapshots.before_ns),
      snapshots_(options_.output, options_.snapshots),
      last_ns_(now_ns) {
  open(now_ns);
  if (snapshots_.wanted()) snapshots_.check(path_);
}

std::size_t RecordingWriter::add_topic(RecordedTopic topic) {
  topics_.push_back(std::move(topic));
  return topics_.size() - 1;
}

void RecordingWriter::open(std::int64_t now_ns) {
  // The last chunk may go beyond the size, and the indexes come on top.
  files_.make_room(
      options_.max_size_bytes + options_.max_size_bytes / 4 + options_.file.chunk_bytes, now_ns);
  path_ = files_.next();
  writer_.emplace(path_, options_.file);
  opened_ns_ = now_ns;
  chunks_seen_ = 0;
  saved_ = totals_.samples;
  channels_.clear();
  schemas_.clear();
  ++totals_.files;
  for (auto& [instance, sample] : last_) {
    sample.log_time_ns = now_ns;
    put(sample);
  }
}

void RecordingWriter::close(std::int64_t now_ns) {
  writer_->finish();
  const RecordingFiles::File file{path_, writer_->bytes_written(), opened_ns_, now_ns, true};
  writer_.reset();
  totals_.bytes += file.bytes;
  files_.finished(file);
  snapshots_.add(file, now_ns);
}

void RecordingWriter::rotate_if_due(std::int64_t now_ns) {
  last_ns_ = now_ns;
  const bool full =
      options_.max_size_bytes > 0 && writer_->bytes_written() >= options_.max_size_bytes;
  const bool old = options_.max_duration_ns > 0 && now_ns - opened_ns_ >= options_.max_duration_ns;
  if (!full && !old && !snapshots_.due(now_ns)) return;
  close(now_ns);
  open(now_ns);
}

void RecordingWriter::write(const RecordedSample& sample) {
  rotate_if_due(sample.log_time_ns);
  if (!sample.sample.valid) return put_lifecycle(sample);
  look_for_gap(sample);
  if (const std::size_t keys = topics_[sample.topic].repeat_last_by; keys > 0)
    keep_to_repeat(sample, keys);
  put(sample);
  ++totals_.samples;
  look_for_alarm(sample);
  if (writer_->chunks() == chunks_seen_) return;
  chunks_seen_ = writer_->chunks();
  saved_ = totals_.samples - (writer_->has_open_chunk() ? 1 : 0);
}

void RecordingWriter::keep_to_repeat(const RecordedSample& sample, std::size_t keys) {
  const auto [entry, is_new] =
      last_.try_emplace({sample.topic, idl::leading_texts(sample.sample.cdr, keys)});
  last_bytes_ += sample.sample.cdr.size() + (is_new ? kBytesPerRepeated : 0);
  last_bytes_ -= entry->second.sample.cdr.size();
  entry->second = sample;
  if (last_bytes_ <= kMostRepeatedBytes) return;
  last_bytes_ -= sample.sample.cdr.size() + kBytesPerRepeated;
  last_.erase(entry);
  if (std::exchange(too_much_to_repeat_, true)) return;
  news_.push_back("the layout of " + printable(idl::unit_of(sample.sample.cdr)) +
                  " and others is in one file only, for those of all units take more than " +
                  bytes_text(kMostRepeatedBytes));
}

void RecordingWriter::put(const RecordedSample& sample) {
  writer_->write(channel_of(sample.topic), sample.log_time_ns, sample.sample.source_time_ns,
                 sample.sample.cdr);
}

void RecordingWriter::put_lifecycle(const RecordedSample& sample) {
  const std::string text = lifecycle_text(sample.sample);
  writer_->write(lifecycle_channel_of(sample.topic), sample.log_time_ns,
                 sample.sample.source_time_ns, bytes_of(text));
}

mcap::ChannelId RecordingWriter::channel_of(std::size_t index) {
  mcap::ChannelId& channel = channels_[index].samples;
  if (channel != 0) return channel;
  const RecordedTopic& topic = topics_[index];
  mcap::SchemaId& schema = schemas_[topic.type];
  if (schema == 0)
    schema = writer_->add_schema(topic.type, topic.idl.empty() ? "" : "omgidl", topic.idl);
  channel = writer_->add_channel(schema, topic.name, "cdr");
  return channel;
}

mcap::ChannelId RecordingWriter::lifecycle_channel_of(std::size_t index) {
  mcap::ChannelId& channel = channels_[index].lifecycle;
  if (channel != 0) return channel;
  mcap::SchemaId& schema = schemas_[kLifecycleSchema];
  if (schema == 0) schema = writer_->add_schema(kLifecycleSchema, "jsonschema", lifecycle_schema());
  channel = writer_->add_channel(schema, topics_[index].name + kLifecycleSuffix, "json");
  return channel;
}

// Says what DDS does not: that a writer had thrown samples away before this reader had them.
void RecordingWriter::look_for_gap(const RecordedSample& sample) {
  if (!topics_[sample.topic].counts_intervals) return;
  const std::optional<idl::SampleStamp> stamp = idl::stamp_of(sample.sample.cdr);
  if (!stamp) return;
  const std::string name = idl::unit_of(sample.sample.cdr);
  if (units_.size() >= kMostUnitNames && units_.count(name) == 0) return;
  UnitIntervals& unit = units_[name];
  const auto [entry, is_new] = unit.topics.try_emplace(sample.topic);
  TopicIntervals& topic = entry->second;
  if (!is_new) topic.missing += missing_between(topic.last, stamp->interval);
  topic.last = stamp->interval;
  if (topic.missing <= unit.missing) return;
  totals_.missing_intervals += topic.missing - unit.missing;
  unit.missing = topic.missing;
}

void RecordingWriter::tick(std::int64_t now_ns) {
  writer_->close_old_chunk(now_ns);
  rotate_if_due(now_ns);
}

void RecordingWriter::look_for_alarm(const RecordedSample& sample) {
  if (!snapshots_.wanted() || topics_[sample.topic].name != idl::kAlarmEventTopic) return;
  if (const std::optional<std::string> name = alarm_snapshot(sample.sample.cdr))
    snapshots_.begin(*name, saturated_difference(sample.log_time_ns, sample.age_ns),
                     options_.snapshots.after_ns, sample.log_time_ns, files_.complete());
}

void RecordingWriter::save(std::int64_t now_ns) {
  snapshots_.begin(hand_snapshot(now_ns), now_ns, 0, now_ns, files_.complete());
  rotate_if_due(now_ns);
}

void RecordingWriter::finish() {
  if (writer_) close(last_ns_);
  snapshots_.finish();
}

void RecordingWriter::give_up() noexcept {
  if (!writer_) return;
  if (writer_->has_open_chunk()) unsaved_ = totals_.samples - saved_;
  try {
    writer_->drop_chunk();
    close(last_ns_);
    snapshots_.finish();
  } catch (const std::exception&) {  // the caller has told already; `mpm recover` mends it
  }
}

std::vector<std::string> RecordingWriter::take_news() {
  std::vector<std::string> news = std::exchange(news_, {});
  for (std::string& line : snapshots_.take_news()) news.push_back(std::move(line));
  return news;
}

RecordingTotals RecordingWriter::totals() const {
  RecordingTotals totals = totals_;
  if (writer_) totals.bytes += writer_->bytes_written();
  totals.deleted = files_.deleted();
  return totals;
}

}  // namespace mpm::bag
