#pragma once

#include <string>

#include "core/signal/frame.hpp"

namespace mpm::io {

/// A signal of a table and where it stands in its frames.
struct Column {
  std::string tag;
  SignalKind kind = SignalKind::kAux;
  int index = 0;
};

}  // namespace mpm::io
