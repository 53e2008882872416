#include "idl/narrow_bind.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>

#include "tests/idl/bound_addresses.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::idl {
namespace {

using test::bound_addresses;
using test::kAllAddresses;
using test::kLoopbackAddress;
using Addresses = std::set<std::string>;

TEST_CASE("a participant on one interface has no socket on any other") {
  REQUIRE(bound_addresses().empty());
  DomainOptions options = test_domain("narrow");
  {
    const Participant participant(options);
    CHECK(bound_addresses() == Addresses{kLoopbackAddress});
  }
  // Those that hear multicast are bound to all, or they would hear none.
  options.multicast = true;
  const Participant participant(options);
  CHECK(bound_addresses() == Addresses{kLoopbackAddress, kAllAddresses});
}

TEST_CASE("other sockets are bound as they ask to be") {
  in_addr loopback{};
  loopback.s_addr = htonl(INADDR_LOOPBACK);
  const auto bound = [](int type) {
    const int socket = ::socket(AF_INET, type, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    socklen_t length = sizeof address;
    REQUIRE(::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length) == 0);
    ::close(socket);
    return address.sin_addr.s_addr;
  };
  CHECK(bound(SOCK_DGRAM) == htonl(INADDR_ANY));
  const NarrowBind narrow(loopback);
  CHECK(bound(SOCK_DGRAM) == htonl(INADDR_LOOPBACK));
  CHECK(bound(SOCK_STREAM) == htonl(INADDR_ANY));
}

}  // namespace
}  // namespace mpm::idl
