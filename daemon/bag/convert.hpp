#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/bag/table.hpp"
#include "daemon/files/times/time_choice.hpp"

namespace mpm::bag {

struct ConvertOptions {
  std::optional<config::UnitConfig> unit;
  std::string unit_name;                               ///< see TableOptions
  files::CsvLayout layout = files::CsvLayout::kWide;   ///< of a CSV output
  bool seconds = false;                                ///< its times as seconds
  files::TimeStyle input_times;                        ///< of a CSV input
  files::TimeChoice choice;                            ///< rows that go over
  std::shared_ptr<const files::TimeZone> output_zone;  ///< null = UTC
};

/// What went over and what did not.
struct ConvertReport {
  std::uint64_t rows = 0;
  std::uint64_t signals = 0;
  std::uint64_t values = 0;     ///< that are there, of whatever quality
  std::uint64_t missing = 0;    ///< cells without a value
  std::uint64_t uncertain = 0;  ///< of the values
  std::uint64_t bad = 0;        ///< of the values
  std::uint64_t bytes = 0;      ///< of the output
  std::int64_t first_ns = 0, last_ns = 0;
  std::vector<std::string> notices;  ///< what was dropped or done, one line each
};

/// MCAP to CSV, CSV to MCAP, CSV to CSV in the other layout. `output` appears when it is whole;
/// "-" is CSV on standard output. Throws config::InputError on bad input, std::runtime_error where
/// it cannot be written.
[[nodiscard]] ConvertReport convert(const std::string& input, const std::string& output,
                                    const ConvertOptions& options);

}  // namespace mpm::bag
