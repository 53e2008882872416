#include "daemon/host/interruptible_input.hpp"

#include <poll.h>
#include <unistd.h>

#include <utility>

namespace mpm::host {
namespace {

constexpr int kLongestWaitMs = 100;

}  // namespace

InterruptibleInput::InterruptibleInput(int descriptor, std::function<bool()> stop)
    : descriptor_(descriptor), stop_(std::move(stop)) {}

InterruptibleInput::int_type InterruptibleInput::underflow() {
  while (!stop_()) {
    pollfd poller{descriptor_, POLLIN, 0};
    if (poll(&poller, 1, kLongestWaitMs) == 0) continue;
    const ssize_t count = read(descriptor_, bytes_.data(), bytes_.size());
    if (count <= 0) break;
    setg(bytes_.data(), bytes_.data(), bytes_.data() + count);
    return traits_type::to_int_type(*gptr());
  }
  return traits_type::eof();
}

}  // namespace mpm::host
