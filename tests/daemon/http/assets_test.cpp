#include "daemon/http/assets.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace mpm::http {
namespace {

TEST_CASE("the page is whole and holds no code of its own that a browser would refuse") {
  const Asset* page = find_asset("/");
  REQUIRE(page != nullptr);
  const std::string text(page->bytes);
  CHECK(text.find("<script src=\"/page.js\" defer></script>") != std::string::npos);
  CHECK(text.find("style=") == std::string::npos);
  CHECK(text.find("onclick") == std::string::npos);
  for (const char* path : {"/page.js", "/page.css", "/api/v1/openapi.json"}) {
    CAPTURE(path);
    const Asset* asset = find_asset(path);
    REQUIRE(asset != nullptr);
    CHECK_FALSE(asset->bytes.empty());
    CHECK(asset->etag.size() == 18);
    CHECK(asset->etag.front() == '"');
  }
  CHECK(find_asset("/index.html") == nullptr);
}

TEST_CASE("the licence of what is bundled comes with it") {
  CHECK(find_asset("/page.js")->bytes.find("uPlot") != std::string_view::npos);
}

}  // namespace
}  // namespace mpm::http
