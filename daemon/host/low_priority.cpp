#include "daemon/host/low_priority.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

namespace mpm::host {

void take_low_priority(const char* name) {
  pthread_setname_np(pthread_self(), name);
  // On Linux both are of the thread, not of the process. Neither needs a privilege, and where a
  // sandbox forbids them the thread merely stays as it is.
  constexpr int kLowest = 19;
  const sched_param none{};
  (void)sched_setscheduler(0, SCHED_BATCH, &none);
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLowest);
}

}  // namespace mpm::host
