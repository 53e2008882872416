#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/files/csv/column.hpp"
#include "daemon/mcap/write/writer.hpp"
#include "idl/cdr.hpp"

namespace mpm::bag {

/// Writes the frames of one unit as the recording that a bus would have given: its layouts and one
/// sample per kind and control interval, each received when it was measured.
class McapFrameWriter {
 public:
  /// `columns`: the signals that there are; a kind without any gets no topic.
  McapFrameWriter(const mcap::OutputPlace& place, const config::UnitConfig& unit,
                  const std::vector<files::Column>& columns);

  /// Throws std::invalid_argument for a time before 1970.
  void write(const Frame& frame);
  void finish() { writer_.finish(); }
  [[nodiscard]] std::uint64_t messages() const { return writer_.messages(); }
  [[nodiscard]] std::uint64_t bytes() const { return writer_.bytes_written(); }

 private:
  void write_layouts(std::int64_t time_ns);

  mcap::Writer writer_;
  config::UnitConfig unit_;
  std::array<std::optional<mcap::ChannelId>, kSignalKindCount> channels_;
  std::array<std::vector<std::string>, kSignalKindCount> tags_;  ///< "" = not in the source
  mcap::ChannelId layouts_ = 0;
  idl::CdrEncoder<mpm_Sample> samples_;
  std::int64_t log_time_ns_ = 0;
  bool begun_ = false;
};

}  // namespace mpm::bag
