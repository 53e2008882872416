#include "daemon/bag/split_name.hpp"

#include <charconv>
#include <system_error>

namespace mpm::bag {

std::optional<SplitName> split_name(const std::string& file_name) {
  constexpr std::size_t kFewest = 4, kMost = 9;
  if (!file_name.ends_with(kExtension)) return std::nullopt;
  const std::string_view whole =
      std::string_view(file_name).substr(0, file_name.size() - kExtension.size());
  const std::size_t dash = whole.rfind('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const std::string_view digits = whole.substr(dash + 1);
  if (digits.size() < kFewest || digits.size() > kMost) return std::nullopt;
  SplitName found{std::string(whole.substr(0, dash)), 0};
  const auto [end, status] =
      std::from_chars(digits.data(), digits.data() + digits.size(), found.number);
  if (status != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return found;
}

}  // namespace mpm::bag
