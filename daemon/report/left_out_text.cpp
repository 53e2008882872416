#include "daemon/report/left_out_text.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/identify/fit/runs.hpp"
#include "core/text/number_text.hpp"
#include "daemon/report/worst_tags.hpp"

namespace mpm::report {

namespace {

std::string jumps_text(const config::UnitConfig& unit, const JumpTally& jumps) {
  std::vector<std::pair<std::string, std::uint64_t>> tags;
  const auto add = [&tags](const std::string& tag, Eigen::Index count) {
    if (count > 0) tags.emplace_back(tag, static_cast<std::uint64_t>(count));
  };
  for (std::size_t i = 0; i < jumps.inputs.size(); ++i)
    add(unit.input_tag(static_cast<int>(i)), jumps.inputs[i]);
  for (std::size_t j = 0; j < jumps.cvs.size(); ++j) add(unit.cv[j].tag, jumps.cvs[j]);
  return counted(static_cast<std::uint64_t>(jumps.total()), "value") +
         " left out, far beyond all that the signal is otherwise" + worst_tags(tags);
}

}  // namespace

std::vector<std::string> left_out_texts(const config::UnitConfig& unit,
                                        const files::RecordingFile& file) {
  std::vector<std::string> texts;
  const auto rows = [&texts](std::int64_t count, const std::string& why) {
    if (count > 0)
      texts.push_back(counted(static_cast<std::uint64_t>(count), "row") + " left out, " + why);
  };
  rows(file.lost, "for an input was missing for more than " + std::to_string(longest_loss()) +
                      " intervals; a new run begins after");
  rows(file.scraps, "of runs too short to tell anything");
  if (file.jumps.total() > 0) texts.push_back(jumps_text(unit, file.jumps));
  return texts;
}

}  // namespace mpm::report
