#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/aligner.hpp"
#include "daemon/bag/contents.hpp"
#include "daemon/bag/sample_stream.hpp"
#include "daemon/files/csv/tag_table.hpp"
#include "daemon/files/frame_source.hpp"
#include "daemon/files/unit_rules.hpp"

namespace mpm::bag {

/// The frames of one unit from an MCAP recording, of one file or several: its samples in the order
/// of their log times, put together by the aligner of the daemon. Log time stands for the daemon's
/// clock, so that a kind that falls silent is given up after the same time; what the daemon saw
/// live comes out again. Memory stays flat.
class McapFrames : public files::FrameSource {
 public:
  /// A frame waits for what the daemon needs to judge the unit or, to keep them, for all kinds in
  /// the file. Throws config::InputError where the file is damaged, or holds no samples of the unit
  /// or not those that it needs.
  McapFrames(const std::vector<std::string>& paths, const config::UnitConfig& unit,
             files::Purpose purpose = files::Purpose::kJudge);

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] double share_read() const override { return samples_.share_read(); }
  [[nodiscard]] const std::vector<std::string>& notices() const override { return notices_; }

 private:
  std::array<bool, kSignalKindCount> look_into(const std::vector<std::string>& paths,
                                               files::Purpose purpose);
  void check_needed(const std::string& path, const RecordedUnit& recorded);
  [[nodiscard]] bool predictions_calculated() const;
  void check_layout(const mpm_Layout& layout);
  void push(const idl::SampleView& sample, std::int64_t now_ns);
  void tell_counters();

  config::UnitConfig unit_;
  files::Purpose purpose_;
  std::vector<std::string> notices_;
  std::deque<Frame> ready_;
  files::UnitRules rules_;
  Aligner aligner_;
  SampleStream samples_;
  std::int64_t patience_ns_;
  std::int64_t last_frame_ns_ = 0;  ///< log time of the last frame, or since when one is awaited
  std::int64_t now_ns_ = 0;
  std::uint64_t of_other_units_ = 0;
  bool done_ = false;
};

}  // namespace mpm::bag
