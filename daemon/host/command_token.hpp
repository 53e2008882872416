#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mpm::host {

/// The secret that those who may give commands share with the daemon. It never goes over the bus:
/// a command carries a proof that its sender knows it, which fits that command alone.
class CommandToken {
 public:
  /// The first line of `path`, 16 letters, digits and marks at least. Throws std::runtime_error
  /// where there is none, or where others than its owner and group may read it.
  static CommandToken read(const std::string& path);
  /// For tests and for what comes from elsewhere.
  explicit CommandToken(std::string_view secret) : secret_(secret) {}

  /// HMAC-SHA-256 of `message`, as 64 hexadecimal digits.
  [[nodiscard]] std::string proof(std::string_view message) const;
  /// In a time that does not tell how far they agree.
  [[nodiscard]] bool proves(std::string_view message, std::string_view proof) const;
  [[nodiscard]] bool is(std::string_view secret) const;

 private:
  std::string secret_;
};

/// So many random bytes, as hexadecimal digits.
[[nodiscard]] std::string random_text(int bytes);

}  // namespace mpm::host
