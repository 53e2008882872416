#include "daemon/app/commands/status_line.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <iostream>

#include "daemon/host/terminal.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::app {
namespace {

constexpr std::chrono::milliseconds kRewritePeriod{200};
constexpr std::chrono::seconds kLinePeriod{10};

}  // namespace

StatusLine::StatusLine()
    : terminal_(isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + (terminal_ ? Clock::duration(kRewritePeriod) : kLinePeriod)) {}

StatusLine::~StatusLine() {
  if (open_) std::cerr << std::endl;
}

bool StatusLine::due(Clock::time_point now) {
  if (now < next_) return false;
  next_ = now + (terminal_ ? Clock::duration(kRewritePeriod) : kLinePeriod);
  return true;
}

void StatusLine::show(const std::string& text) {
  if (terminal_)
    std::cerr << '\r' << report::shortened(text, host::terminal_width(STDERR_FILENO) - 1)
              << "\x1b[K" << std::flush;
  else
    std::cerr << text << std::endl;
  open_ = terminal_;
}

void StatusLine::say(const std::string& text) {
  if (open_) std::cerr << '\r';
  std::cerr << text << (open_ ? "\x1b[K" : "") << std::endl;
  open_ = false;
}

std::string bytes_text(double bytes) {
  static constexpr std::array kUnits = {"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 1000.0 && unit + 1 < kUnits.size()) {
    bytes /= 1000.0;
    ++unit;
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f %s" : "%.1f %s", bytes, kUnits[unit]);
  return text.data();
}

}  // namespace mpm::app
