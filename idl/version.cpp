#include "idl/version.hpp"

#include <dds/version.h>

namespace mpm::idl {

const char* cyclone_version() { return DDS_VERSION; }

}  // namespace mpm::idl
