#include "daemon/http/guard.hpp"

#include <catch2/catch.hpp>

namespace mpm::http {
namespace {

TEST_CASE("numbers, localhost and given names address this server; other names do not") {
  const Guard guard({"Monitor.plant"}, std::nullopt);
  for (const char* host : {"127.0.0.1:8080", "10.1.2.3", "[::1]:8080", "localhost:80", "LOCALHOST",
                           "monitor.plant:443"}) {
    CAPTURE(host);
    CHECK(guard.is_addressed(host));
  }
  for (const char* host : {"", "evil.example", "127.0.0.1.evil.example:8080", "localhost.evil",
                           "[::1", "monitor.plant.evil"}) {
    CAPTURE(host);
    CHECK_FALSE(guard.is_addressed(host));
  }
}

TEST_CASE("only our own page and programs may change anything") {
  CHECK(Guard::is_own("", "", "127.0.0.1:80"));
  CHECK(Guard::is_own("http://127.0.0.1:80", "same-origin", "127.0.0.1:80"));
  CHECK(Guard::is_own("https://monitor.plant", "", "monitor.plant"));
  CHECK_FALSE(Guard::is_own("http://evil.example", "", "127.0.0.1:80"));
  CHECK_FALSE(Guard::is_own("http://127.0.0.1:81", "", "127.0.0.1:80"));
  CHECK_FALSE(Guard::is_own("null", "", "127.0.0.1:80"));
  CHECK_FALSE(Guard::is_own("", "cross-site", "127.0.0.1:80"));
  CHECK_FALSE(Guard::is_own("", "same-site", "127.0.0.1:80"));
}

TEST_CASE("the whole token and nothing else is right") {
  const Guard guard({}, host::CommandToken("0123456789abcdef"));
  CHECK(guard.takes_commands());
  CHECK(guard.is_authorized("Bearer 0123456789abcdef"));
  for (const char* given : {"", "Bearer ", "Bearer 0123456789abcde", "Bearer 0123456789abcdefg",
                            "Bearer 0123456789abcdeg", "Basic 0123456789abcdef",
                            "Bearer 0123456789abcdef0123456789abcdef"}) {
    CAPTURE(given);
    CHECK_FALSE(guard.is_authorized(given));
  }
  const Guard none({}, std::nullopt);
  CHECK_FALSE(none.takes_commands());
  CHECK_FALSE(none.is_authorized("Bearer "));
}

}  // namespace
}  // namespace mpm::http
