#pragma once

namespace mpm::host {

/// Gives the system what the process has freed and the C library would keep: after work that takes
/// far more than what goes on all the time.
void give_memory_back();

}  // namespace mpm::host
