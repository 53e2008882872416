#pragma once

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace mpm::test {

/// As the kernel writes addresses of IPv4.
inline const std::string kLoopbackAddress = "0100007F", kAllAddresses = "00000000";

/// The addresses that sockets of a process ("self": this one) are bound to, for UDP and TCP over
/// IPv4, as /proc has them and `ss` shows them.
[[nodiscard]] inline std::set<std::string> bound_addresses(const std::string& process = "self") {
  const std::string own = "/proc/" + process;
  std::set<std::string> inodes, addresses;
  for (const auto& entry : std::filesystem::directory_iterator(own + "/fd")) {
    std::error_code gone;  // the one that lists them
    const std::string target = std::filesystem::read_symlink(entry.path(), gone).string();
    if (target.starts_with("socket:[")) inodes.insert(target.substr(8, target.size() - 9));
  }
  for (const char* protocol : {"/net/udp", "/net/tcp"}) {
    std::ifstream table(own + protocol);
    std::string line;
    std::getline(table, line);  // sl local_address rem_address st queues tr:when retr uid tmo inode
    while (std::getline(table, line)) {
      std::istringstream words(line);
      std::string local, word;
      words >> word >> local;
      for (int i = 0; i < 8; ++i) words >> word;
      if (inodes.count(word) > 0) addresses.insert(local.substr(0, local.find(':')));
    }
  }
  return addresses;
}

}  // namespace mpm::test
