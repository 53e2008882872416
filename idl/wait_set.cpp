#include "idl/wait_set.hpp"

namespace mpm::idl {

WaitSet::WaitSet() : wait_set_(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "wait set") {}

void WaitSet::attach(dds_entity_t condition) {
  check(dds_waitset_attach(wait_set_.get(), condition, 0), "attach to wait set");
}

bool WaitSet::wait(std::chrono::nanoseconds timeout) const {
  return check(dds_waitset_wait(wait_set_.get(), nullptr, 0, timeout.count()), "wait") > 0;
}

}  // namespace mpm::idl
