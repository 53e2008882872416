#pragma once

namespace mpm::host {

/// What the process has freed, to the system, which the C library would keep for later.
void give_memory_back();

}  // namespace mpm::host
