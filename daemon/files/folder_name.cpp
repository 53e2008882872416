#include "daemon/files/folder_name.hpp"

#include <array>
#include <cctype>
#include <cinttypes>
#include <cstdio>

#include "core/signal/nanoseconds.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

// A file system's names end at 255 bytes; numbers, times and endings come behind.
constexpr std::size_t kLongest = 200, kEnding = 17;
constexpr std::uint64_t kHashStart = 0xcbf29ce484222325, kHashFactor = 0x100000001b3;

}  // namespace

std::string time_folder(std::int64_t time_ns) {
  const std::int64_t second = floor_division(time_ns, kSecondNs);
  const std::int64_t part = (time_ns % kSecondNs + kSecondNs) % kSecondNs;
  std::string name = formatted_utc(second, "%Y%m%dT%H%M%S");
  const auto milliseconds = static_cast<int>(part / 1'000'000);
  if (milliseconds > 0) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), ".%03d", milliseconds);
    name += text.data();
  }
  return name + "Z";
}

std::string folder_name(const std::string& name) {
  std::string result;
  for (const char letter : name) {
    const auto code = static_cast<unsigned char>(letter);
    if (std::isalnum(code) != 0 || letter == '-' || letter == '_' ||
        (letter == '.' && !result.empty())) {
      result += letter;
      continue;
    }
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "%%%02X", static_cast<unsigned>(code));
    result += text.data();
  }
  if (result.size() <= kLongest) return result;
  std::uint64_t hash = kHashStart;  // FNV-1a (Fowler, Noll, Vo): of names that begin alike
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * kHashFactor;
  std::array<char, 24> ending{};
  std::snprintf(ending.data(), ending.size(), "~%016" PRIx64, hash);
  return result.substr(0, kLongest - kEnding) + ending.data();
}

}  // namespace mpm::files
