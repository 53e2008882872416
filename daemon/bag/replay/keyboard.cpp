#include "daemon/bag/replay/keyboard.hpp"

#include <poll.h>
#include <unistd.h>

namespace mpm::bag {
namespace {

// A byte that is there; 0 otherwise.
char read_byte() {
  pollfd poller{STDIN_FILENO, POLLIN, 0};
  char byte = 0;
  if (poll(&poller, 1, 0) != 1 || read(STDIN_FILENO, &byte, 1) != 1) return 0;
  return byte;
}

Key arrow(char last) {
  switch (last) {
    case 'A':
      return Key::kFaster;
    case 'B':
      return Key::kSlower;
    case 'C':
      return Key::kStep;
    default:
      return Key::kNone;
  }
}

}  // namespace

Keyboard::Keyboard() {
  termios settings{};
  // In the background a change of the terminal would stop the process.
  if (isatty(STDIN_FILENO) == 0 || tcgetpgrp(STDIN_FILENO) != getpgrp() ||
      tcgetattr(STDIN_FILENO, &settings) != 0)
    return;
  before_ = settings;
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

Keyboard::~Keyboard() {
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
}

Key Keyboard::next() {
  if (!before_) return Key::kNone;
  switch (read_byte()) {
    case ' ':
      return Key::kPause;
    case 's':
      return Key::kStep;
    case '+':
    case '=':
      return Key::kFaster;
    case '-':
      return Key::kSlower;
    case 'q':
      return Key::kQuit;
    case '\x1b':
      return read_byte() == '[' ? arrow(read_byte()) : Key::kNone;
    default:
      return Key::kNone;
  }
}

}  // namespace mpm::bag
