#include "daemon/keys/documents.hpp"

#include <catch2/catch.hpp>

namespace mpm::keys {
namespace {

// The names of elements are those of DDS Security 1.1, 9.4.1.3.
TEST_CASE("permissions name topics and times, and deny the rest") {
  // 86400 s are a day.
  const std::string xml = permissions_xml({{"mpm/*"}, {}}, "CN=viewer", {0, 86400});
  const auto has = [&xml](const char* text) { return xml.find(text) != std::string::npos; };
  CHECK(has("<subject_name>CN=viewer</subject_name>"));
  CHECK(has("<not_before>1970-01-01T00:00:00Z</not_before>"));
  CHECK(has("<not_after>1970-01-02T00:00:00Z</not_after>"));
  CHECK(has("<subscribe><topics>\n      <topic>mpm/*</topic>\n    </topics>"));
  CHECK_FALSE(has("<publish>"));
  CHECK(has("<default>DENY</default>"));
}

}  // namespace
}  // namespace mpm::keys
