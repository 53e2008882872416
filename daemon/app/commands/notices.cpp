#include "daemon/app/commands/notices.hpp"

#include <unistd.h>

#include <iostream>

#include "daemon/host/terminal.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::app {

void tell_notices(const std::vector<std::string>& notices, const std::string& about) {
  const bool terminal = host::is_terminal(STDERR_FILENO);
  const std::size_t width = host::terminal_width(STDERR_FILENO);
  for (const std::string& notice : notices) {
    const bool told = about.empty() || notice.starts_with(about + ": ");
    const std::string text = told ? notice : about + ": " + notice;
    std::cerr << (terminal ? report::wrapped(text, 0, width) : text + '\n');
  }
}

}  // namespace mpm::app
