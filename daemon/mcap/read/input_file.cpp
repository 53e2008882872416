#include "daemon/mcap/read/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "config/finding.hpp"

namespace mpm::mcap {
namespace {

constexpr std::uint64_t kReadAhead = 64U << 10U;

}  // namespace

InputFile::InputFile(const std::string& path)
    // Nobody may ever write to a pipe: not to wait there before it is refused.
    : name_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  const auto refuse = [&](const std::string& message) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw config::InputError({name_, 0, 0, config::Severity::kError, "", message});
  };
  if (descriptor_ < 0)
    refuse(errno == ENOENT ? "no such file"
                           : std::string("cannot be read: ") + std::strerror(errno));
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) refuse("cannot be read");
  if (S_ISDIR(status.st_mode)) refuse("is a folder, not a file");
  if (!S_ISREG(status.st_mode)) refuse("is no regular file");
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

ByteView InputFile::view(std::uint64_t offset, std::uint64_t length) {
  if (offset > size_ || length > size_ - offset) fail(size_, "the file ends here");
  if (offset < buffer_offset_ || offset + length > buffer_offset_ + buffer_.size()) {
    buffer_.resize(std::min(std::max(length, kReadAhead), size_ - offset));
    buffer_offset_ = offset;
    for (std::size_t done = 0; done < buffer_.size();) {
      const ssize_t count = ::pread(descriptor_, buffer_.data() + done, buffer_.size() - done,
                                    static_cast<off_t>(offset + done));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        const std::string why = count < 0 ? std::strerror(errno) : "it became shorter";
        buffer_.clear();
        fail(offset + done, "cannot be read: " + why);
      }
      done += static_cast<std::size_t>(count);
    }
  }
  return ByteView(buffer_).subspan(offset - buffer_offset_, length);
}

void InputFile::fail(std::uint64_t offset, const std::string& what) const {
  throw config::InputError(
      {name_, 0, 0, config::Severity::kError, "byte " + std::to_string(offset), what});
}

}  // namespace mpm::mcap
