#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/files/csv/column.hpp"
#include "daemon/files/csv/csv_writer.hpp"
#include "daemon/files/frame_source.hpp"
#include "daemon/files/times/time_style.hpp"

namespace mpm::bag {

/// What to read of a file.
struct TableOptions {
  const config::UnitConfig* unit = nullptr;  ///< its signals; null = whatever the file tells
  std::string unit_name;                     ///< of several in an MCAP file; empty = the only one
  files::TimeStyle times;                    ///< of a CSV file
  bool number = false;                       ///< the frames need the unit's interval numbers
};

/// A data file of either kind as rows of named signals.
struct Table {
  config::UnitConfig unit;  ///< as given, or made of what the file tells
  std::vector<files::Column> columns;
  std::unique_ptr<files::FrameSource> frames;
  std::vector<std::string> notices;  ///< what of the file is not in the columns
};

/// Throws config::InputError where the file cannot be read so.
[[nodiscard]] Table open_table(const std::string& path, const TableOptions& options);

}  // namespace mpm::bag
