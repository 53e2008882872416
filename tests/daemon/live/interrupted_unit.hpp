#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/performance/performance_window.hpp"
#include "core/signal/aligner.hpp"
#include "daemon/files/calculator.hpp"
#include "daemon/live/diagnosis_schedule.hpp"
#include "daemon/live/frame_ring.hpp"
#include "daemon/report/unit_monitor.hpp"

namespace mpm::test {

/// What a unit goes through. Numbers are samples; 0 or less: never.
struct Ordeal {
  std::string name;
  config::UnitConfig config;
  int samples = 2000;
  std::uint64_t seed = 1;
  int change_from = 0,
      change_until = 0;               ///< the gain of the first channel is 1.8 times the model's
  double bend = 0.0;                  ///< CV 0 has that share of its own square besides
  double follows = 0.0;               ///< CV 0 has so much of the auxiliary signal in it
  bool predicted = true;              ///< predictions come
  int first_prediction = 0;           ///< they come from then on
  int none_from = 0, none_until = 0;  ///< but not then
  bool troubles = false;  ///< gaps, bad and missing values, spikes, values that stand, wild ones
  bool shuffled = false;  ///< blocks late, twice and out of order, and a restart of the numbers
  double quantum = 0.0;   ///< of the last CV's readings
  int held_until = 0;     ///< the last CV's values come through a historian's deadband
  int rest_from = 0, rest_until = 0;  ///< the controller is off
};

/// The frames of an ordeal, one per sample, by the wall.
[[nodiscard]] std::vector<Frame> frames_of(const Ordeal& ordeal);

/// All of a unit that the samples change, as mpmd has it, and what it said of each frame.
class OneUnit {
 public:
  explicit OneUnit(const config::UnitConfig& config);

  /// The sample's blocks, in the ordeal's order.
  void take(const Ordeal& ordeal, const std::vector<Frame>& frames, int sample);
  [[nodiscard]] std::vector<std::byte> put_away() const;
  void take_back(std::span<const std::byte> bytes);
  /// All that can be asked, each number with all its bits.
  [[nodiscard]] std::string all();
  /// What was said since this was asked last.
  [[nodiscard]] std::string said() { return std::move(said_); }

  [[nodiscard]] report::UnitMonitor& monitor() { return monitor_; }
  [[nodiscard]] const AlignerCounters& aligned() const { return aligner_.counters(); }

 private:
  void on_frame(const Frame& frame);

  config::UnitConfig config_;
  report::UnitMonitor monitor_;
  PerformanceWindow performance_;
  live::FrameRing ring_;
  live::DiagnosisSchedule schedule_;
  files::Calculator calculator_;
  Frame calculated_;
  Aligner aligner_;
  const Frame* sample_ = nullptr;
  std::string said_;
};

}  // namespace mpm::test
