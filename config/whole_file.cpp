#include "config/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "config/failure_text.hpp"

namespace mpm::config {
namespace {

// No stream: one that fails while it is read throws without a reason, or ends as the file does.
std::optional<std::string> read_all(int file, std::string& why) {
  struct stat status {};
  if (::fstat(file, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) {
    why = "no regular file";
    return std::nullopt;
  }
  std::string text;
  std::array<char, 65536> block{};
  while (true) {
    const ssize_t count = ::read(file, block.data(), block.size());
    if (count == 0) return text;
    if (count > 0) {
      text.append(block.data(), static_cast<std::size_t>(count));
    } else if (errno != EINTR) {  // of a folder, too
      why = failure_text(errno);
      return std::nullopt;
    }
  }
}

}  // namespace

std::optional<std::string> read_whole_file(const std::string& path, std::string& why) {
  // Nobody may ever write to a pipe: not to wait there before it is refused.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    why = failure_text(errno);
    return std::nullopt;
  }
  std::optional<std::string> text = read_all(file, why);
  ::close(file);
  return text;
}

}  // namespace mpm::config
