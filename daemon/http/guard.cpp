#include "daemon/http/guard.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <stdexcept>

#include "daemon/http/address.hpp"

namespace mpm::http {
namespace {

constexpr std::size_t kLongestName = 256;

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return result;
}

/// Of "name:8080" and "[::1]:8080" without the port and the brackets.
std::string host_of(std::string_view text) {
  if (!text.empty() && text.front() == '[') {
    const std::size_t end = text.find(']');
    return std::string(text.substr(1, end == std::string_view::npos ? 0 : end - 1));
  }
  return lower(text.substr(0, text.find(':')));
}

}  // namespace

Guard::Guard(std::vector<std::string> names, std::optional<host::CommandToken> token)
    : names_(std::move(names)), token_(std::move(token)) {
  for (std::string& name : names_) name = lower(name);
  names_.emplace_back("localhost");
  std::array<char, kLongestName> own{};
  if (gethostname(own.data(), own.size() - 1) == 0 && own[0] != '\0') {
    names_.push_back(lower(own.data()));
    names_.push_back(names_.back().substr(0, names_.back().find('.')));
  }
}

bool Guard::is_addressed(std::string_view host) const {
  const std::string name = host_of(host);
  return is_ip_address(name) || std::find(names_.begin(), names_.end(), name) != names_.end();
}

bool Guard::is_own(std::string_view origin, std::string_view site, std::string_view host) {
  if (!site.empty() && site != "same-origin" && site != "none") return false;
  if (origin.empty()) return true;  // of no page
  const std::size_t scheme = origin.find("://");
  return scheme != std::string_view::npos &&
         lower(origin.substr(scheme + 3)) == lower(host);  // http, or https of a proxy before us
}

bool Guard::is_authorized(std::string_view authorization) const {
  constexpr std::string_view kScheme = "Bearer ";
  return token_ && authorization.substr(0, kScheme.size()) == kScheme &&
         token_->is(authorization.substr(kScheme.size()));
}

}  // namespace mpm::http
