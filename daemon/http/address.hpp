#pragma once

#include <optional>
#include <string>

namespace mpm::http {

/// Where a server listens.
struct Address {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any that is free

  [[nodiscard]] bool is_local() const { return host == "127.0.0.1" || host == "::1"; }
  /// "http://127.0.0.1:8080/"
  [[nodiscard]] std::string url() const;
};

/// "8080", "10.0.0.5:8080", "[::1]:8080", "0.0.0.0:0"; nothing where it is none of these. Names are
/// none: which interface a name means is not to be guessed.
[[nodiscard]] std::optional<Address> parse_address(const std::string& text);

/// Why nobody can listen there: `error` is an errno.
[[nodiscard]] std::string bind_problem(int error);

/// The address as a number, IPv4 or IPv6.
[[nodiscard]] bool is_ip_address(const std::string& host);

}  // namespace mpm::http
