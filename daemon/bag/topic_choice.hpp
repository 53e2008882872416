#pragma once

#include <set>
#include <string>
#include <vector>

namespace mpm::bag {

/// Which topics a person wants, with the words of `ros2 bag`.
struct TopicChoice {
  std::vector<std::string> names;    ///< --topics
  std::string regex;                 ///< --regex: of our topics those that it matches, besides
  std::vector<std::string> exclude;  ///< --exclude-topics: but not these
  std::string exclude_regex;         ///< --exclude-regex: nor those that it matches
};

/// The topics chosen, of `by_default` where neither names nor a regex choose any. A regex (that of
/// ECMAScript) may match any part of a name. Throws std::invalid_argument, with the option's name,
/// where one is none, matches none of ours or is too long, where what is excluded is no topic of
/// ours or by name, and where nothing is left.
[[nodiscard]] std::set<std::string> chosen_topics(const TopicChoice& choice,
                                                  const std::vector<std::string>& by_default);

}  // namespace mpm::bag
