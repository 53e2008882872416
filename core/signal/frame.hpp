#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/signal/calibration.hpp"

namespace mpm {

/// OPC UA severity of one value. Bad values are never used, nor those that claim to be good and
/// that `Screen` finds implausible.
enum class Quality : std::uint8_t { kGood = 0, kUncertain = 1, kBad = 2, kImplausible = 3 };

/// The groups of signals of a unit; one DDS topic each (aux: files only). Raw ones are there for
/// others to be calculated from, and no statistic uses them.
enum class SignalKind : std::uint8_t { kMv, kDv, kCv, kPrediction, kSetpoint, kAux, kRaw };
inline constexpr std::size_t kSignalKindCount = 7;

/// Number of signals of each kind; predictions and set-points count one per CV.
struct SignalCounts {
  int mv = 0;
  int dv = 0;
  int cv = 0;
  int aux = 0;
  int raw = 0;

  [[nodiscard]] int of(SignalKind kind) const {
    switch (kind) {
      case SignalKind::kMv:
        return mv;
      case SignalKind::kDv:
        return dv;
      case SignalKind::kAux:
        return aux;
      case SignalKind::kRaw:
        return raw;
      default:
        return cv;
    }
  }
  /// Inputs of the model: MVs first, then DVs.
  [[nodiscard]] int inputs() const { return mv + dv; }
};

/// Values of one kind at one control interval, each with its quality.
struct SignalBlock {
  Eigen::VectorXd values;
  std::vector<Quality> quality;

  void resize(int count) {
    values.setZero(count);
    quality.assign(static_cast<std::size_t>(count), Quality::kBad);
  }
  [[nodiscard]] int size() const { return static_cast<int>(values.size()); }
  /// True where the value may enter a statistic: not bad, and of a size that an instrument gives.
  [[nodiscard]] bool usable(int index) const {
    return quality[static_cast<std::size_t>(index)] <= Quality::kUncertain &&
           std::abs(values(index)) <= calibration::extent::kLargest;  // false for NaN
  }
  template <class Archive>
  void archive(Archive& a) {
    a(values);
    a.length(quality.size());
    for (Quality& each : quality) a.within(each, Quality::kGood, Quality::kImplausible);
  }
};

/// Everything known about one unit at one control interval k. The row convention is that of the
/// sampled loop: y(k) was measured, then u(k) was computed from it and acts from k until k+1, so
/// y(k) depends on u(k-1), u(k-2), ...; prediction(k) likewise.
struct Frame {
  std::int64_t interval = 0;        ///< k, counted by the controller
  std::int64_t source_time_ns = 0;  ///< UTC, since 1970
  std::array<SignalBlock, kSignalKindCount> blocks;

  Frame() = default;
  explicit Frame(const SignalCounts& counts) {
    for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
      blocks[kind].resize(counts.of(static_cast<SignalKind>(kind)));
  }
  [[nodiscard]] SignalBlock& operator[](SignalKind kind) {
    return blocks[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] const SignalBlock& operator[](SignalKind kind) const {
    return blocks[static_cast<std::size_t>(kind)];
  }
  template <class Archive>
  void archive(Archive& a) {
    a(interval, blocks);
    a.time(source_time_ns);
  }
};

}  // namespace mpm
