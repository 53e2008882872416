#include "config/failure_text.hpp"

#include <catch2/catch.hpp>
#include <cerrno>
#include <string>

namespace mpm::config {

TEST_CASE("a failure is told in the system's words, with the user where something is forbidden") {
  CHECK(failure_text(ENOENT) == "No such file or directory");
  const std::string forbidden = failure_text(EACCES);
  CHECK(forbidden.rfind("Permission denied (for user ", 0) == 0);
  CHECK(forbidden.size() > std::string("Permission denied (for user )").size());
}

}  // namespace mpm::config
