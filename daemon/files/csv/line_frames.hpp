#pragma once

#include <array>
#include <cstdint>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"
#include "daemon/files/times/time_style.hpp"

namespace mpm::files {

enum class LineFormat { kAuto, kJson, kCsv };

/// Frames of one unit from lines of text as they come, without reading ahead:
///   CSV   a header `time,<tag>,...`, then one row per interval, as in a data file
///   JSON  one object per line: {"time": 12.0, "u1": 0.5, "u1.quality": "uncertain", ...}
/// Missing tags, null and the words of a data file for "no value" are bad values. An interval is
/// numbered round((time - first time) / sample_time) as in `mpm detect`, unless a JSON line gives
/// its own "interval".
class LineFrames {
 public:
  /// Reads the first line. Local times without a zone in `times` are refused. Throws
  /// config::InputError (`name:line:col: error: message`).
  LineFrames(std::unique_ptr<std::istream> input, const std::string& name, LineFormat format,
             const config::UnitConfig& unit, const TimeStyle& times = {});
  ~LineFrames();

  /// False at the end. After an InputError the next line may be read.
  [[nodiscard]] bool next(Frame& frame);
  /// Kinds that no line will have; of a CSV file without such columns.
  [[nodiscard]] const std::array<bool, kSignalKindCount>& absent() const { return absent_; }
  /// What the user should know, since the last call.
  [[nodiscard]] std::vector<std::string> take_notices();

  /// Where lines become rows; how depends on the format.
  class Rows;

 private:
  std::unique_ptr<Rows> rows_;
  double sample_time_s_;
  std::array<bool, kSignalKindCount> absent_{};
  bool started_ = false;
  std::int64_t first_ns_ = 0;
};

}  // namespace mpm::files
