#pragma once

#include <memory>

#include "daemon/http/address.hpp"
#include "daemon/http/api.hpp"
#include "daemon/http/board.hpp"

namespace mpm::http {

/// Serves page, API and event stream. Connections are few and short: each carries one request but
/// the event streams, of which there is a bounded number; requests are small and there at once
/// (`Intake`), and who reads no answer is dropped.
class Server {
 public:
  static constexpr std::size_t kMostStreams = 32;

  /// Binds. Throws std::runtime_error where the address cannot be had. `parts.server` is its own.
  Server(const Address& address, Board& board, Api::Parts parts);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  /// Ends all connections.
  ~Server();

  void start();
  /// With the port that it really has.
  [[nodiscard]] const Address& address() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mpm::http
