#include "idl/wait_set.hpp"

#include <array>

namespace mpm::idl {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kLongestSleep{1};
constexpr dds_attach_t kReader = 0, kWaker = 1;

}  // namespace

WaitSet::WaitSet()
    : wait_set_(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "wait set"),
      waker_(dds_create_guardcondition(DDS_CYCLONEDDS_HANDLE), "guard condition") {
  check(dds_waitset_attach(wait_set_.get(), waker_.get(), kWaker), "attach to wait set");
  thread_ = std::thread([this] { wake_now_and_then(); });
}

WaitSet::~WaitSet() {
  {
    const MutexLock lock(mutex_);
    over_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void WaitSet::wake_now_and_then() {
  MutexLock lock(mutex_);
  while (!over_) {
    if (changed_.wait_until(lock, Clock::now() + kLongestSleep)) continue;
    dds_set_guardcondition(waker_.get(), true);
  }
}

void WaitSet::attach(dds_entity_t condition) {
  check(dds_waitset_attach(wait_set_.get(), condition, kReader), "attach to wait set");
}

bool WaitSet::wait(std::chrono::nanoseconds timeout) const {
  const Clock::time_point end = Clock::now() + timeout;
  std::chrono::nanoseconds left = timeout;
  while (true) {
    std::array<dds_attach_t, 2> which{};  // two suffice to see one that is no waker
    const dds_return_t count =
        check(dds_waitset_wait(wait_set_.get(), which.data(), which.size(), left.count()), "wait");
    const auto is_reader = [&](int i) {
      return i < count && which.at(static_cast<std::size_t>(i)) == kReader;
    };
    if (is_reader(0) || is_reader(1)) return true;
    if (count > 0) dds_set_guardcondition(waker_.get(), false);
    left = end - Clock::now();
    if (left <= std::chrono::nanoseconds::zero()) return false;
  }
}

bool WaitSet::ready() const {
  dds_attach_t which{};
  return check(dds_waitset_wait(wait_set_.get(), &which, 1, 0), "wait") > 0;
}

}  // namespace mpm::idl
