#include "daemon/mcap/write/output_file.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace mpm::mcap {
namespace {

constexpr std::size_t kSpillBytes = 256U << 10U;

/// False with errno where not all could be written.
bool write_all(int descriptor, ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

int open_file(const std::string& path, OutputFile::Opening opening) {
  const int how = opening == OutputFile::Opening::kMakeNew ? O_EXCL : O_TRUNC;
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | how, 0666);
}

std::uint64_t most_file_bytes() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0) return std::numeric_limits<std::uint64_t>::max();
  return limit.rlim_cur;
}

}  // namespace

OutputFile::OutputFile(const OutputPlace& place, Opening opening)
    : path_(place.path),
      descriptor_(place.descriptor >= 0 ? ::fcntl(place.descriptor, F_DUPFD_CLOEXEC, 0)
                                        : open_file(place.path, opening)),
      most_bytes_(most_file_bytes()) {
  if (descriptor_ < 0) fail("cannot be written to");
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool OutputFile::make_room(std::uint64_t bytes) {
  if (bytes > most_bytes_) {
    errno = EFBIG;
    return false;
  }
  if (bytes <= reserved_) return true;
  if (::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(reserved_),
                  static_cast<off_t>(bytes - reserved_)) == 0)
    reserved_ = bytes;
  else if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG)
    return false;
  return true;  // or the file system promises nothing
}

void OutputFile::write(ByteView bytes, std::uint64_t reserve) {
  if (!make_room(size_ + bytes.size() + reserve)) fail("cannot be written to");
  if (!write_all(descriptor_, bytes)) {
    const int reason = errno;
    // Best effort: where even this fails, `mpm recover` cuts the rest off.
    if (::ftruncate(descriptor_, static_cast<off_t>(size_)) == 0)
      ::lseek(descriptor_, static_cast<off_t>(size_), SEEK_SET);
    errno = reason;
    fail("cannot be written to");
  }
  size_ += bytes.size();
  crc_.add(bytes);
}

void OutputFile::close() {
  if (reserved_ > size_) static_cast<void>(::ftruncate(descriptor_, static_cast<off_t>(size_)));
  const int result = ::close(descriptor_);
  descriptor_ = -1;
  if (result != 0) fail("could not be closed");
}

void OutputFile::fail(const char* what) const {
  throw std::runtime_error(path_ + ": " + what + ": " + std::strerror(errno));
}

SpillFile::~SpillFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SpillFile::add(ByteView bytes) {
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  if (buffer_.size() >= kSpillBytes && spill()) buffer_.clear();
}

bool SpillFile::spill() {
  if (descriptor_ < 0) {
    std::string name = path_ + ".index.XXXXXX";
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ < 0) return false;
    ::unlink(name.c_str());
  }
  // Over what a failed attempt may have left.
  if (::lseek(descriptor_, static_cast<off_t>(spilled_), SEEK_SET) < 0) return false;
  if (!write_all(descriptor_, buffer_)) return false;
  spilled_ += buffer_.size();
  return true;
}

void SpillFile::copy_to(OutputFile& out) {
  Bytes piece;
  for (std::uint64_t at = 0; at < spilled_; at += piece.size()) {
    piece.resize(std::min<std::uint64_t>(kSpillBytes, spilled_ - at));
    const ssize_t count = ::pread(descriptor_, piece.data(), piece.size(), static_cast<off_t>(at));
    if (count <= 0) fail();
    piece.resize(static_cast<std::size_t>(count));
    out.write(piece);
  }
  out.write(buffer_);
}

void SpillFile::fail() const {
  throw std::runtime_error(path_ + ": the index cannot be kept: " + std::strerror(errno));
}

}  // namespace mpm::mcap
