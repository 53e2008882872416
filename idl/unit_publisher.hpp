#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "core/signal/frame.hpp"
#include "core/signal/unit_layout.hpp"
#include "idl/participant.hpp"
#include "idl/writer.hpp"

namespace mpm::idl {

/// Plays the control system of one unit: writes its layout once and then each frame as up to six
/// samples. For simulation and replay; the monitor never makes one.
class UnitPublisher {
 public:
  UnitPublisher(const Participant& participant, UnitLayout layout, WriterPace pace);

  /// Waits until every topic has so many readers that know its writer, so that the first frame is
  /// not lost to discovery. False after `timeout`.
  [[nodiscard]] bool wait_for_readers(std::chrono::milliseconds timeout, int readers = 1) const;

  /// False if readers did not take it in time (kLossless: 10 s).
  [[nodiscard]] bool publish(const Frame& frame) const;

  /// Waits until the readers have all that was published; false after `timeout`.
  [[nodiscard]] bool flush(std::chrono::milliseconds timeout) const;

 private:
  void write_layout() const;

  UnitLayout layout_;
  Writer<mpm_Layout> layout_writer_;
  std::array<std::optional<Writer<mpm_Sample>>, kSignalKindCount> writers_;
};

}  // namespace mpm::idl
