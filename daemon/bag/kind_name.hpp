#pragma once

#include "core/signal/frame.hpp"

namespace mpm::recording {

/// "mv" ... "aux".
[[nodiscard]] const char* name_of(SignalKind kind);

}  // namespace mpm::recording
