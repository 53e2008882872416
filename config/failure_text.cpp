#include "config/failure_text.hpp"

#include <pwd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace mpm::config {
namespace {

constexpr std::size_t kRoomForNames = 16384;  // of all that the system knows of a user

std::string user_name() {
  passwd entry{};
  passwd* found = nullptr;
  std::array<char, kRoomForNames> room{};
  if (getpwuid_r(geteuid(), &entry, room.data(), room.size(), &found) == 0 && found != nullptr)
    return found->pw_name;
  return std::to_string(geteuid());
}

}  // namespace

std::string failure_text(int error) {
  const std::string text = std::generic_category().message(error);
  return error == EACCES || error == EPERM ? text + " (for user " + user_name() + ")" : text;
}

}  // namespace mpm::config
