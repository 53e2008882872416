#pragma once

#include "core/signal/frame.hpp"

namespace mpm::bag {

/// "mv" ... "aux".
[[nodiscard]] const char* name_of(SignalKind kind);

}  // namespace mpm::bag
