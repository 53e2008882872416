#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/bag/record/recording_files.hpp"
#include "daemon/bag/record/sample_queue.hpp"
#include "daemon/bag/record/snapshots.hpp"
#include "daemon/mcap/write/writer.hpp"

namespace mpm::bag {

struct RecordingOptions {
  std::string output;                ///< see RecordingFiles
  std::uint64_t max_size_bytes = 0;  ///< of one file; 0 = no limit
  std::int64_t max_duration_ns = 0;  ///< of one file; 0 = no limit
  std::uint64_t quota_bytes = 0;     ///< of all files; 0 = no limit
  SnapshotOptions snapshots;         ///< where there are any, older files go
  mcap::WriterOptions file;
};

/// A topic as the recording describes it.
struct RecordedTopic {
  std::string name;
  std::string type;
  std::string idl;  ///< text of the type; empty where it is not known
  /// > 0: the key is so many strings, and every file begins with the last sample of each instance.
  std::size_t repeat_last_by = 0;
  bool counts_intervals = false;  ///< mpm::Sample
};

/// What went into a recording so far.
struct RecordingTotals {
  std::uint64_t samples = 0;
  std::uint64_t bytes = 0;  ///< of all its files, those deleted included
  std::uint64_t files = 0;
  std::uint64_t deleted = 0;  ///< files, for the quota
  /// Left out in the numbers of the units' input topics; of each unit those of the topic that lacks
  /// most, so that an interval of which all is missing counts once.
  std::uint64_t missing_intervals = 0;
};

/// Samples into MCAP files, one after the other. Each file is whole by itself: types, and the
/// layout of every unit seen so far, as far as they take 16 MB.
///
/// A sample goes to the channel of its topic as the CDR that it was; log time is when it was
/// received, publish time its DDS source time. That an instance ended goes to `<topic>/_lifecycle`
/// as JSON, with the key's CDR in hexadecimal: MCAP itself has no place for it.
///
/// With snapshots it keeps no more than they may need, and an alarm that becomes active (a sample
/// of mpm/alarm_event) makes one, in `OUTPUT/saved`.
class RecordingWriter {
 public:
  /// `now_ns`: UTC since 1970, as all times here. Throws std::runtime_error where a file cannot be
  /// written, std::invalid_argument where there is one already, or snapshots cannot be made there.
  RecordingWriter(const RecordingOptions& options, std::int64_t now_ns);

  /// Returns the index for RecordedSample.
  std::size_t add_topic(RecordedTopic topic);
  void write(const RecordedSample& sample);
  /// For when nothing comes: closes a chunk or a file that is old enough.
  void tick(std::int64_t now_ns);
  /// A snapshot by hand: what there is up to now.
  void save(std::int64_t now_ns);
  void finish();
  /// After a failure: the file is finished with what fitted, as far as the disk lets it.
  void give_up() noexcept;

  [[nodiscard]] RecordingTotals totals() const;
  /// What there is to tell, in whole sentences, since the last call.
  [[nodiscard]] std::vector<std::string> take_news();
  /// Of the samples, those that were given up.
  [[nodiscard]] std::uint64_t unsaved() const { return unsaved_; }
  /// The file that is being written.
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  struct TopicIntervals {
    std::int64_t last = 0;
    std::uint64_t missing = 0;
  };
  struct UnitIntervals {
    std::map<std::size_t, TopicIntervals> topics;
    std::uint64_t missing = 0;  // of the topic that lacks most
  };
  struct Channels {
    mcap::SchemaId schema = 0;
    mcap::ChannelId samples = 0, lifecycle = 0;
  };

  void open(std::int64_t now_ns);
  void close(std::int64_t now_ns);
  void look_for_alarm(const RecordedSample& sample);
  void rotate_if_due(std::int64_t now_ns);
  void put(const RecordedSample& sample);
  void put_lifecycle(const RecordedSample& sample);
  [[nodiscard]] mcap::ChannelId channel_of(std::size_t topic);
  [[nodiscard]] mcap::ChannelId lifecycle_channel_of(std::size_t topic);
  void look_for_gap(const RecordedSample& sample);
  void keep_to_repeat(const RecordedSample& sample, std::size_t keys);

  RecordingOptions options_;
  RecordingFiles files_;
  Snapshots snapshots_;
  std::vector<RecordedTopic> topics_;
  std::optional<mcap::Writer> writer_;
  std::string path_;
  std::int64_t opened_ns_ = 0;
  std::int64_t last_ns_ = 0;                  // the latest that was heard of the time
  std::map<std::size_t, Channels> channels_;  // of the open file
  std::map<std::string, mcap::SchemaId> schemas_;
  std::map<std::pair<std::size_t, std::vector<std::string>>, RecordedSample> last_;  // to repeat
  std::size_t last_bytes_ = 0;                                                       // of these
  std::vector<std::string> news_;
  bool too_much_to_repeat_ = false;
  std::map<std::string, UnitIntervals> units_;
  RecordingTotals totals_;
  std::uint64_t chunks_seen_ = 0;  // of the open file
  std::uint64_t saved_ = 0;        // samples before the open chunk
  std::uint64_t unsaved_ = 0;
};

}  // namespace mpm::bag
