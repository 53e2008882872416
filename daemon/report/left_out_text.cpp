#include "daemon/report/left_out_text.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/text/number_text.hpp"
#include "daemon/report/worst_tags.hpp"

namespace mpm::report {

std::string left_out_text(const config::UnitConfig& unit, const JumpTally& jumps) {
  if (jumps.total() == 0) return {};
  std::vector<std::pair<std::string, std::uint64_t>> tags;
  const auto add = [&tags](const std::string& tag, Eigen::Index count) {
    if (count > 0) tags.emplace_back(tag, static_cast<std::uint64_t>(count));
  };
  for (std::size_t i = 0; i < jumps.inputs.size(); ++i)
    add(unit.input_tag(static_cast<int>(i)), jumps.inputs[i]);
  for (std::size_t j = 0; j < jumps.cvs.size(); ++j) add(unit.cv[j].tag, jumps.cvs[j]);
  return counted(static_cast<std::uint64_t>(jumps.total()), "value") +
         " left out, far beyond all that the signal had been and back at once" + worst_tags(tags);
}

}  // namespace mpm::report
