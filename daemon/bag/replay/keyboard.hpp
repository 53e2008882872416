#pragma once

#include <termios.h>

#include <optional>

#include "daemon/bag/replay/player.hpp"

namespace mpm::bag {

/// Single keys from the terminal on standard input; none where it is no terminal. The terminal is
/// as before afterwards.
class Keyboard {
 public:
  Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;
  ~Keyboard();

  /// The next one pressed, or kNone; never waits.
  [[nodiscard]] Key next();
  [[nodiscard]] bool there() const { return before_.has_value(); }

 private:
  std::optional<termios> before_;
};

}  // namespace mpm::bag
