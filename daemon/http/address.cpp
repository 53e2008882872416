#include "daemon/http/address.hpp"

#include <arpa/inet.h>

#include <cerrno>
#include <charconv>
#include <system_error>

namespace mpm::http {

bool is_ip_address(const std::string& host) {
  in6_addr place{};
  return inet_pton(AF_INET, host.c_str(), &place) == 1 ||
         inet_pton(AF_INET6, host.c_str(), &place) == 1;
}

std::string Address::url() const {
  const bool six = host.find(':') != std::string::npos;
  return "http://" + (six ? "[" + host + "]" : host) + ":" + std::to_string(port) + "/";
}

std::string bind_problem(int error) {
  switch (error) {
    case EADDRINUSE:
      return "the port is taken";
    case EADDRNOTAVAIL:
      return "the address is none of this machine";
    case EACCES:
      return "this user may not take that port (permission denied)";
    case 0:
      return "the port is taken, or the address is none of this machine";
    default:
      return std::generic_category().message(error);
  }
}

std::optional<Address> parse_address(const std::string& text) {
  Address address;
  std::string port = text;
  if (const std::size_t colon = text.rfind(':'); colon != std::string::npos) {
    address.host = text.substr(0, colon);
    port = text.substr(colon + 1);
    const bool six =
        address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
    if (six) address.host = address.host.substr(1, address.host.size() - 2);
    if (!is_ip_address(address.host) || six != (address.host.find(':') != std::string::npos))
      return std::nullopt;
  }
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  constexpr int kMostPorts = 65535;
  if (port.empty() || error != std::errc() || end != port.data() + port.size() ||
      address.port < 0 || address.port > kMostPorts)
    return std::nullopt;
  return address;
}

}  // namespace mpm::http
