#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/signal/frame.hpp"
#include "daemon/files/times/time_choice.hpp"
#include "daemon/files/times/time_style.hpp"

namespace mpm::bag {

/// Values of one signal by quality.
struct SignalTally {
  std::string tag;
  std::uint64_t good = 0, uncertain = 0, bad = 0;
  std::uint64_t missing = 0;  ///< no value at all

  void add(double value, Quality quality);
};

/// Times of rows or samples and where some are missing between them.
struct TimeTally {
  std::uint64_t count = 0;
  std::int64_t first_ns = 0, last_ns = 0;  ///< earliest, latest
  std::uint64_t gaps = 0;
  std::uint64_t missing = 0;  ///< control intervals in the gaps
  std::int64_t longest_gap_ns = 0;
  std::int64_t longest_gap_at_ns = 0;  ///< the last time before it
  std::uint64_t out_of_order = 0;      ///< rows not later than the one before
  std::int64_t farthest_back_ns = 0;
  std::int64_t farthest_back_at_ns = 0;  ///< the time before that step

  void add(std::int64_t time_ns);
  void add_gap(std::int64_t before_ns, std::int64_t after_ns, std::uint64_t intervals);
  void add_step_back(std::int64_t before_ns, std::int64_t after_ns);
  /// Per second; 0 where that cannot be told.
  [[nodiscard]] double rate_hz() const;
};

/// The samples of one unit on one topic.
struct SampleTally {
  SignalKind kind = SignalKind::kMv;
  TimeTally times;  ///< source times
  std::vector<SignalTally> signals;
  std::int64_t last_interval = 0;
  std::int64_t last_ns = 0;
  bool cut = false;  ///< something was left out on purpose since the last sample
};

struct UnitTally {
  double sample_time_s = 0.0;  ///< 0 = not known
  std::map<SignalKind, SampleTally> samples;
};

struct TopicTally {
  std::string type;             ///< name of the schema
  std::string schema_encoding;  ///< omgidl ...
  std::string message_encoding;
  TimeTally times;  ///< log times
  std::uint64_t bytes = 0;
};

/// What a data file, or a recording of several, holds.
struct FileInfo {
  std::string path;                ///< the name of all where there are several
  std::vector<std::string> files;  ///< of MCAP, in the order of time
  bool is_mcap = false;
  std::uint64_t bytes = 0;
  TimeTally times;      ///< of all messages or rows
  std::string problem;  ///< where reading ended, if not at the end; empty = the file is whole

  // MCAP
  std::string library, profile;
  std::string index_problem;  ///< empty = intact
  std::uint64_t chunks = 0, packed_bytes = 0, unpacked_bytes = 0;
  std::set<std::string> compressions;
  std::map<std::string, TopicTally> topics;
  std::map<std::string, UnitTally> units;

  // CSV
  std::string layout = "wide";  ///< long: a row for each tag and time; pairs: a time for each tag
  char delimiter = ',';
  double step_s = 0.0;  ///< median of the first rows
  std::vector<SignalTally> signals;
  std::vector<std::string> notices;
};

/// Reads of the files what `choice` takes: rows of a CSV by their time, messages of an MCAP by when
/// they were recorded. What was left out on purpose is no gap. Several MCAP files, or a folder of
/// them, are one recording. Throws config::InputError where it is no data file at all; one that is
/// torn is told as far as it goes. Local times of a CSV without a zone in `times` are refused.
[[nodiscard]] FileInfo inspect(const std::vector<std::string>& paths,
                               const files::TimeStyle& times = {},
                               const files::TimeChoice& choice = {});
[[nodiscard]] FileInfo inspect(const std::string& path, const files::TimeStyle& times = {});

}  // namespace mpm::bag
