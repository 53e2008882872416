#pragma once

namespace mpm::host {

/// Names the calling thread (15 letters) and puts it behind every other thread of the machine that
/// wants to run, as far as the system permits. Not SCHED_IDLE: on a machine that is always busy
/// that is never, and nice 19 is still a seventieth of a core.
void take_low_priority(const char* name);

}  // namespace mpm::host
