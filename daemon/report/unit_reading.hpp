#pragma once

#include <span>
#include <vector>

#include "config/unit_config.hpp"
#include "core/monitor/unit_reader.hpp"

namespace mpm::report {

/// What the monitor of a unit reads of its frames, at a small part of the cost: nothing is judged.
class UnitReading {
 public:
  explicit UnitReading(const config::UnitConfig& unit);

  /// The CVs of this frame and of those before that came to be read (`Monitor::judged`); none of a
  /// frame that is not newer than the last. Valid until the next one.
  std::span<const JudgedFrame> push(const Frame& frame);

 private:
  [[nodiscard]] UnitReader fresh() const;

  config::UnitConfig unit_;
  LinearModel model_;
  UnitReader reader_;
  std::vector<JudgedFrame> judged_;  // room for all that may be read at once
  std::int64_t last_ = 0;            // interval
  bool first_ = true;
};

}  // namespace mpm::report
