#include "daemon/recording/kind_name.hpp"

#include "idl/topics.hpp"

namespace mpm::recording {

const char* name_of(SignalKind kind) {
  return kind == SignalKind::kAux ? "aux" : idl::kind_name(kind);
}

}  // namespace mpm::recording
