#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/files/frame_source.hpp"
#include "daemon/files/times/time_style.hpp"

namespace mpm::bag {

/// Several data files, CSV or MCAP, as one in the order of their first rows. The intervals go on
/// from file to file by the time between them; rows that are no later than the end of the file
/// before are left out, and counted in the notices. One file is open at a time.
class FrameSequence : public files::FrameSource {
 public:
  /// Looks at the first row of each. Throws as `open_recording` does.
  FrameSequence(const std::vector<std::string>& paths, const config::UnitConfig& unit,
                const files::TimeStyle& times);

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] double share_read() const override;
  [[nodiscard]] const std::vector<std::string>& notices() const override { return notices_; }

 private:
  void open_next();
  void close();

  config::UnitConfig unit_;
  files::TimeStyle times_;
  std::vector<std::string> paths_;  // by first row
  std::size_t next_ = 0;            // of them
  std::unique_ptr<files::FrameSource> open_;
  std::optional<std::int64_t> shift_;  // of the open file's intervals
  std::uint64_t overlapping_ = 0;      // rows of it
  bool any_ = false;
  std::int64_t last_interval_ = 0, last_ns_ = 0;
  std::vector<std::string> notices_;
};

}  // namespace mpm::bag
