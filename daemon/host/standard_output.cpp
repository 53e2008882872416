#include "daemon/host/standard_output.hpp"

#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace mpm::host {

bool reader_has_left() {
  pollfd poller{STDOUT_FILENO, 0, 0};
  return poll(&poller, 1, 0) == 1 && (poller.revents & (POLLERR | POLLHUP)) != 0;
}

bool finish_standard_output() {
  std::cout.flush();
  std::fflush(stdout);
  const bool written = std::cout.good() && std::ferror(stdout) == 0;
  return written || reader_has_left();
}

}  // namespace mpm::host
