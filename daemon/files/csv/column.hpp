#pragma once

#include <string>

#include "core/signal/frame.hpp"

namespace mpm::files {

/// A signal of a table and where it stands in its frames.
struct Column {
  std::string tag;
  SignalKind kind = SignalKind::kAux;
  int index = 0;
};

}  // namespace mpm::files
