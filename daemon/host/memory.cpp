#include "daemon/host/memory.hpp"

#include <malloc.h>

namespace mpm::host {

void give_memory_back() { (void)malloc_trim(0); }

}  // namespace mpm::host
