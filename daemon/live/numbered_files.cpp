#include "daemon/live/numbered_files.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>

namespace mpm::live {

namespace fs = std::filesystem;

std::string numbered_path(const std::string& folder, std::string_view prefix,
                          std::uint64_t number) {
  return fmt::format("{}/{}{:012}", folder, prefix, number);
}

std::vector<std::uint64_t> numbers_in(const std::string& folder, std::string_view prefix) {
  std::vector<std::uint64_t> numbers;
  std::error_code failed;
  for (auto entry = fs::directory_iterator(folder, failed);
       !failed && entry != fs::directory_iterator(); entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(prefix)) continue;
    std::uint64_t number = 0;
    const char* end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data() + prefix.size(), end, number);
    if (error == std::errc() && stop == end &&
        entry->path() == numbered_path(folder, prefix, number))
      numbers.push_back(number);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace mpm::live
