#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/monitor/calibration.hpp"
#include "core/signal/frame.hpp"

namespace mpm {

class Archive;

/// Why a signal has no value that can be used.
enum class LossCause {
  kNoValue,      ///< NaN, or not there at all
  kQuality,      ///< whoever sends it says that it is bad
  kImplausible,  ///< none that a process gives (`Screen`)
};

/// A signal that has been without a usable value for so long that no verdict can be drawn.
struct LostSignal {
  SignalKind kind = SignalKind::kMv;
  int index = 0;  ///< within the kind
  LossCause cause = LossCause::kNoValue;
  std::int64_t since_ns = 0;  ///< source time of the first sample without one
  std::int64_t last_ns = 0;   ///< of the last one
};

/// Which signals are lost. By the share of unusable values lately, not by a run: a few bad values
/// lose nothing, and a good one now and then brings nothing back.
class LostSignals {
 public:
  /// `lags`: samples without an input after which no channel of it has a verdict.
  LostSignals(const SignalCounts& counts, int lags);

  /// Each signal once per frame; `usable`: whether its value there serves.
  void take(const Frame& frame, SignalKind kind, int index, bool usable);
  /// MVs, DVs, CVs, predictions; within a kind in their order.
  [[nodiscard]] std::vector<LostSignal> list() const;

  void archive(Archive& a);

 private:
  struct Loss {
    double share = 0.0;  // of unusable values, exponentially weighted
    bool usable = true;  // the last one
    bool lost = false;
    LossCause cause = LossCause::kNoValue;
    std::int64_t since_ns = 0;
    std::int64_t last_ns = 0;
    void archive(Archive& a);
  };

  double step_;
  std::array<std::vector<Loss>, kSignalKindCount> losses_;
};

}  // namespace mpm
