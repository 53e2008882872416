#pragma once

#include <ctime>
#include <string>

#include "daemon/keys/role.hpp"

namespace mpm::keys {

struct Validity {
  std::time_t from = 0, until = 0;  ///< UTC
};

/// What holds on a secured bus (DDS Security 1.1, 9.4.1.2): nobody without a certificate takes
/// part; who is there, is alive and says what is encrypted, every packet is signed, and each reader
/// and writer needs a permission.
[[nodiscard]] std::string governance_xml();

/// What one participant may do (ibid. 9.4.1.3): `role`'s topics, and nothing else. `subject`: that
/// of its certificate, as "CN=monitor".
[[nodiscard]] std::string permissions_xml(const Permissions& role, const std::string& subject,
                                          const Validity& validity);

}  // namespace mpm::keys
