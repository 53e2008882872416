#include "daemon/report/page/page.hpp"

#include <string_view>

namespace mpm::report {

// Written by page/embed.cmake from the files of the same names.
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kDrawJs;
extern const std::string_view kPageJs;
extern const std::string_view kUplotJs;
extern const std::string_view kUplotCss;
extern const std::string_view kUplotLicense;

namespace {

/// No `<` in the text can end the element that holds it.
std::string safe_json(const nlohmann::ordered_json& data) {
  // Tags may hold any bytes; a page must be UTF-8.
  const std::string plain =
      data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size());
  for (const char letter : plain) {
    if (letter == '<')
      text += "\\u003c";
    else
      text += letter;
  }
  return text;
}

std::string escaped(const std::string& plain) {
  std::string text;
  for (const char letter : plain) {
    if (letter == '&')
      text += "&amp;";
    else if (letter == '<')
      text += "&lt;";
    else if (letter == '>')
      text += "&gt;";
    else
      text += letter;
  }
  return text;
}

}  // namespace

std::string page_html(const nlohmann::ordered_json& data) {
  std::string page;
  std::string_view rest = kPageHtml;
  // Places in the template look like <!--name--> and stand for one text each.
  constexpr std::string_view kOpen = "<!--", kClose = "-->";
  for (auto open = rest.find(kOpen); open != std::string_view::npos; open = rest.find(kOpen)) {
    page += rest.substr(0, open);
    const auto close = rest.find(kClose, open);
    const std::string_view name = rest.substr(open + kOpen.size(), close - open - kOpen.size());
    if (name == "title") page += escaped(data["title"].get<std::string>());
    if (name == "kicker") page += escaped(data["kicker"].get<std::string>());
    if (name == "sentence") page += escaped(data["sentence"].get<std::string>());
    if (name == "style") page.append(kUplotCss).append("\n").append(kPageCss);
    if (name == "data") page += safe_json(data);
    if (name == "licence") page += kUplotLicense;
    if (name == "script") page.append(kUplotJs).append(kDrawJs).append(kPageJs);
    rest.remove_prefix(close + kClose.size());
  }
  return page.append(rest);
}

}  // namespace mpm::report
