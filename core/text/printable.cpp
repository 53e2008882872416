#include "daemon/mcap/format/printable.hpp"

#include <algorithm>

namespace mpm::mcap {

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 100;
  std::string result(text.substr(0, kLongest));
  if (text.size() > kLongest) result += "...";
  std::replace_if(
      result.begin(), result.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, '?');
  return result;
}

}  // namespace mpm::mcap
