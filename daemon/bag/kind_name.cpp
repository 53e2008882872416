#include "daemon/bag/kind_name.hpp"

#include "idl/topics.hpp"

namespace mpm::bag {

const char* name_of(SignalKind kind) {
  return kind == SignalKind::kAux ? "aux" : idl::kind_name(kind);
}

}  // namespace mpm::bag
