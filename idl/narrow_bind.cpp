#include "idl/narrow_bind.hpp"

#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstring>

namespace mpm::idl {
namespace {

thread_local in_addr_t narrow_to = INADDR_ANY;

bool is_for_unicast(int socket) {
  int type = 0, shared = 0;
  socklen_t size = sizeof(int);
  const bool known = getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) == 0 &&
                     getsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &shared, &size) == 0;
  return known && type == SOCK_DGRAM && shared == 0;  // of a multicast port there are several
}

}  // namespace

NarrowBind::NarrowBind(in_addr address) { narrow_to = address.s_addr; }
NarrowBind::~NarrowBind() { narrow_to = INADDR_ANY; }

}  // namespace mpm::idl

// In place of the C library's, for the whole process: a program's own symbols come before those of
// the libraries that it loads.
extern "C" __attribute__((visibility("default"))) int bind(int socket, const sockaddr* address,
                                                           socklen_t length) noexcept {
  sockaddr_in narrow{};
  if (mpm::idl::narrow_to != INADDR_ANY && length >= sizeof narrow &&
      address->sa_family == AF_INET) {
    std::memcpy(&narrow, address, sizeof narrow);
    if (narrow.sin_addr.s_addr == INADDR_ANY && mpm::idl::is_for_unicast(socket)) {
      narrow.sin_addr.s_addr = mpm::idl::narrow_to;
      address = reinterpret_cast<const sockaddr*>(&narrow);
      length = sizeof narrow;
    }
  }
  return static_cast<int>(syscall(SYS_bind, socket, address, length));
}
