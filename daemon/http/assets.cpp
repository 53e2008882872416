#include "daemon/http/assets.hpp"

#include <algorithm>
#include <array>

namespace mpm::http {

// Written by page/embed.cmake from the files of the same names.
extern const std::string_view kIndexHtml, kIndexHtmlTag;
extern const std::string_view kPageJs, kPageJsTag;
extern const std::string_view kPageCss, kPageCssTag;
extern const std::string_view kOpenapiJson, kOpenapiJsonTag;

const Asset* find_asset(std::string_view path) {
  static const std::array assets{
      Asset{"/", "text/html; charset=utf-8", kIndexHtml, kIndexHtmlTag},
      Asset{"/page.js", "text/javascript; charset=utf-8", kPageJs, kPageJsTag},
      Asset{"/page.css", "text/css; charset=utf-8", kPageCss, kPageCssTag},
      Asset{"/api/v1/openapi.json", "application/json; charset=utf-8", kOpenapiJson,
            kOpenapiJsonTag},
  };
  const auto found = std::find_if(assets.begin(), assets.end(),
                                  [path](const Asset& asset) { return asset.path == path; });
  return found == assets.end() ? nullptr : &*found;
}

}  // namespace mpm::http
