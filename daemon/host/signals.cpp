#include "daemon/host/signals.hpp"

#include <pthread.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

namespace mpm::host {

AwaitedSignal::AwaitedSignal(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    // Who started the program may want it left alone (nohup), and a blocked signal would come.
    if (now.sa_handler != SIG_IGN) sigaddset(&set, signal);
  }
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  fd_ = signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
  if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
}

AwaitedSignal::~AwaitedSignal() { close(fd_); }

bool AwaitedSignal::take() {
  signalfd_siginfo info;
  return read(fd_, &info, sizeof info) == sizeof info;
}

bool StopSignal::received() {
  if (signal_.take()) received_ = true;
  return received_;
}

}  // namespace mpm::host
