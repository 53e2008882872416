#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/signal/saturated.hpp"
#include "daemon/bag/replay/replay_source.hpp"
#include "idl/raw_writer.hpp"

namespace mpm::bag {

/// Makes the passes of a replay in a loop one long run. From pass to pass the interval numbers and
/// times of each unit's samples go on, with one interval left out at the seam: what was before and
/// after it was never one movement of the plant, and a monitor starts its windows afresh at a gap,
/// as it does when a controller restarts.
class LoopShift {
 public:
  /// Notes where the sample lies in its pass. All of one pass, in any order.
  void see(const ReplaySample& sample, const std::string& unit);
  /// The pass is over.
  void next_pass();

  /// What to add to a sample of this unit in the current pass.
  [[nodiscard]] idl::SampleChange change_of(const std::string& unit) const;
  /// To the time stamps that DDS carries, of all topics, ns.
  [[nodiscard]] std::int64_t time_shift_ns() const { return time_shift_ns_; }

 private:
  struct Span {
    bool seen = false;
    std::int64_t first = 0, last = 0;
    void add(std::int64_t value);
    [[nodiscard]] std::int64_t length() const { return saturated_difference(last, first); }
  };
  struct Unit {
    Span intervals, times_ns;
    std::int64_t add_intervals = 0, add_time_ns = 0;
  };

  std::map<std::string, Unit> units_;
  Span written_ns_;
  std::int64_t time_shift_ns_ = 0;
};

}  // namespace mpm::bag
