#include "daemon/http/process_load.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace mpm::http {
namespace {

TEST_CASE("memory that is used is seen, and time never goes back") {
  const ProcessLoad before = process_load();
  const std::vector<char> block(64U << 20U, 'x');
  const ProcessLoad after = process_load();
  CHECK(before.resident_bytes > 0);
  CHECK(after.resident_bytes > before.resident_bytes + block.size() / 2);
  CHECK(after.processor_seconds >= before.processor_seconds);
}

}  // namespace
}  // namespace mpm::http
