#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"

namespace mpm::sim {

/// Frames as the project's data file: `time`, then set-points, MVs, DVs, CVs, predictions and the
/// aux signals that move by tag; what has no tag has no column. A value that is not finite is an
/// empty field. Tags in `quality_tags` have a column `<tag>.quality` behind theirs: good, uncertain
/// or bad. Numbers are the shortest text that reads back to the same double; `time` is start_s +
/// interval * sample_time.
class CsvWriter {
 public:
  CsvWriter(std::ostream& out, const config::UnitConfig& unit, double start_s,
            const std::vector<std::string>& quality_tags = {});

  /// `time_error_s` is what the time stamp is off by.
  void write(const Frame& frame, double time_error_s = 0.0);

 private:
  struct Column {
    SignalKind kind;
    int index;
    bool has_quality;
  };
  void append(double value);

  std::ostream& out_;
  double sample_time_s_, start_s_;
  std::vector<Column> columns_;
  std::string line_;
};

}  // namespace mpm::sim
