#pragma once

#include <string>
#include <vector>

#include "core/signal/frame.hpp"

namespace mpm::files {

/// Frames of one unit in the order of a file, whatever its format.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Fills `frame`; false at the end. Throws config::InputError on bad input.
  [[nodiscard]] virtual bool next(Frame& frame) = 0;
  /// How much of the file has been read, 0..1; stays 0 where that is not known.
  [[nodiscard]] virtual double share_read() const { return 0.0; }
  /// What the user should know but need not act on, complete after the last frame.
  [[nodiscard]] virtual const std::vector<std::string>& notices() const = 0;
};

}  // namespace mpm::files
