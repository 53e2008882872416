#include "daemon/report/worst_tags.hpp"

#include <algorithm>

#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"

namespace mpm::report {

std::string worst_tags(std::vector<std::pair<std::string, std::uint64_t>> bad_values) {
  constexpr std::size_t kNamed = 3;
  std::stable_sort(bad_values.begin(), bad_values.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (std::size_t i = 0; i < bad_values.size() && i < kNamed; ++i)
    text += (i == 0 ? ", of " : ", ") + printable(bad_values[i].first) + " (" +
            std::to_string(bad_values[i].second) + ")";
  return bad_values.size() > kNamed ? text + " and " + counted(bad_values.size() - kNamed, "other")
                                    : text;
}

}  // namespace mpm::report
