#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"

namespace mpm::sim {

/// Frames as the project's data file: `time`, then set-points, MVs, DVs, CVs and predictions by
/// tag; what has no tag has no column. Numbers are the shortest text that reads back to the same
/// double; `time` is start_s + interval * sample_time.
class CsvWriter {
 public:
  CsvWriter(std::ostream& out, const config::UnitConfig& unit, double start_s);

  void write(const Frame& frame);

 private:
  struct Column {
    SignalKind kind;
    int index;
  };
  void append(double value);

  std::ostream& out_;
  double sample_time_s_, start_s_;
  std::vector<Column> columns_;
  std::string line_;
};

}  // namespace mpm::sim
