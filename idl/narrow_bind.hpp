#pragma once

#include <netinet/in.h>

namespace mpm::idl {

/// While one lives, the UDP sockets that its thread binds to all addresses of the machine are bound
/// to one alone. Cyclone 0.10 binds the sockets that it receives unicast on to all, whatever
/// interface it is told. Those for multicast must stay so, or they would hear none.
class NarrowBind {
 public:
  /// INADDR_ANY: leaves all as it is.
  explicit NarrowBind(in_addr address);
  NarrowBind(const NarrowBind&) = delete;
  NarrowBind& operator=(const NarrowBind&) = delete;
  ~NarrowBind();
};

}  // namespace mpm::idl
