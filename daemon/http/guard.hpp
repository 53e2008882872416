#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/host/command_token.hpp"

namespace mpm::http {

/// Who may ask what. A browser sends whatever a page of somebody else's tells it to, so that a
/// server on loopback is open to the whole web unless it looks at whom a request is addressed to
/// and where it comes from.
class Guard {
 public:
  /// `names`: host names by which this server is called, beside `localhost`, this machine's own
  /// name and addresses in numbers. `token`: what commands need; none: none are taken.
  Guard(std::vector<std::string> names, std::optional<host::CommandToken> token);

  /// Against DNS rebinding: a page elsewhere can make its own name mean this machine, but no number
  /// and none of ours. `host`: the header's value.
  [[nodiscard]] bool is_addressed(std::string_view host) const;
  /// Whether a request that changes something comes from our own page or from no page at all.
  /// `origin`, `site`: of the headers Origin and Sec-Fetch-Site, empty where they are not there.
  [[nodiscard]] static bool is_own(std::string_view origin, std::string_view site,
                                   std::string_view host);
  [[nodiscard]] bool takes_commands() const { return token_.has_value(); }
  /// `authorization`: the header's value. Takes as long whatever part of it is right.
  [[nodiscard]] bool is_authorized(std::string_view authorization) const;

 private:
  std::vector<std::string> names_;
  std::optional<host::CommandToken> token_;
};

}  // namespace mpm::http
