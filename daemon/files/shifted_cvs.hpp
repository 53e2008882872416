#pragma once

#include "daemon/files/frame_source.hpp"

namespace mpm::files {

/// A recording with its CVs a row earlier or later beside all else: whether what looks like errors
/// of a model comes of time stamps that are a row off. Ends with what it is of.
class ShiftedCvs : public FrameSource {
 public:
  enum class Way { kEarlier, kLater };

  /// `source` must outlive it.
  ShiftedCvs(FrameSource& source, const SignalCounts& counts, Way way)
      : source_(source), before_(counts), way_(way) {}

  /// CVs are bad where the row that they are from is missing.
  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] double share_read() const override { return source_.share_read(); }
  [[nodiscard]] const std::vector<std::string>& notices() const override {
    return source_.notices();
  }

 private:
  FrameSource& source_;
  Frame before_;
  Way way_;
  bool begun_ = false;
};

}  // namespace mpm::files
