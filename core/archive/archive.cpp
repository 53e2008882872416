#include "core/archive/archive.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/archive/calibration.hpp"

namespace mpm {

void Archive::refuse(const std::string& what) const {
  throw std::runtime_error("what was put away does not fit here: " + what + ", " +
                           std::to_string(left()) + " bytes before its end");
}

void Archive::bytes(void* memory, std::size_t count) {
  if (!reads()) return append(static_cast<const std::byte*>(memory), count);
  if (count == 0) return;
  if (count > in_.size()) refuse("it ends too early");
  std::memcpy(memory, in_.data(), count);
  in_ = in_.subspan(count);
}

void Archive::append(const std::byte* from, std::size_t count) {
  while (count > 0) {
    if (stop_ && before_look_ == 0) {
      if (stop_()) throw Stopped{};
      before_look_ = calibration::archive::kPiece;
    }
    const std::size_t piece = stop_ ? std::min(count, before_look_) : count;
    out_->insert(out_->end(), from, from + piece);
    from += piece;
    count -= piece;
    if (stop_) before_look_ -= piece;
  }
}

void Archive::length(std::size_t fixed) {
  std::uint64_t there = fixed;
  item(there);
  if (there != fixed)
    refuse(std::to_string(there) + " values where " + std::to_string(fixed) + " belong");
}

// Nothing is so small that it takes less than a byte.
std::size_t Archive::varying_length(std::size_t length) {
  std::uint64_t there = length;
  item(there);
  require(there <= left(), "more values than bytes");
  return static_cast<std::size_t>(there);
}

void Archive::item(bool& flag) {
  auto byte = static_cast<unsigned char>(flag ? 1 : 0);
  bytes(&byte, 1);
  require(byte <= 1, "neither true nor false");
  flag = byte == 1;
}

void Archive::item(std::string& text) {
  const std::size_t length = varying_length(text.size());
  if (reads()) text.resize(length);
  bytes(text.data(), length);
}

void Archive::item(std::vector<bool>& list) {
  length(list.size());
  for (std::vector<bool>::reference each : list) {
    bool flag = each;
    item(flag);
    each = flag;
  }
}

}  // namespace mpm
