#include "idl/entity.hpp"

#include "idl/log.hpp"

namespace mpm::idl {

dds_return_t check(dds_return_t code, const std::string& what) {
  if (code >= 0) return code;
  std::string message = "DDS: " + what + ": " + dds_strretcode(code);
  if (const std::string reason = last_log_line(); !reason.empty()) message += " (" + reason + ")";
  throw Error(message);
}

}  // namespace mpm::idl
