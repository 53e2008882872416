#include "daemon/http/address.hpp"

#include <catch2/catch.hpp>
#include <cerrno>

namespace mpm::http {
namespace {

TEST_CASE("a port alone means this machine alone") {
  const auto address = parse_address("8080");
  REQUIRE(address);
  CHECK(address->host == "127.0.0.1");
  CHECK(address->is_local());
  CHECK(address->url() == "http://127.0.0.1:8080/");
}

TEST_CASE("an address of the network is to be written") {
  CHECK(parse_address("0.0.0.0:80")->host == "0.0.0.0");
  CHECK_FALSE(parse_address("0.0.0.0:80")->is_local());
  CHECK(parse_address("[::1]:0")->host == "::1");
  CHECK(parse_address("[::1]:8")->url() == "http://[::1]:8/");
}

TEST_CASE("what is no address is refused") {
  for (const char* text : {"", "x", ":80", "host:80", "127.0.0.1", "127.0.0.1:", "1.2.3:80",
                           "::1:80", "8080x", "-1", "65536", "[127.0.0.1]:80"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_address(text));
  }
}

TEST_CASE("why nobody can listen is told apart") {
  CHECK(bind_problem(EADDRINUSE) == "the port is taken");
  CHECK(bind_problem(EADDRNOTAVAIL) == "the address is none of this machine");
  CHECK(bind_problem(EACCES) == "this user may not take that port (permission denied)");
}

}  // namespace
}  // namespace mpm::http
