#include "daemon/bag/topic_choice.hpp"

#include <algorithm>
#include <regex>
#include <stdexcept>

#include "idl/topic_catalog.hpp"

namespace mpm::bag {
namespace {

// What std::regex needs grows with the pattern; names are those of ours or the person's own.
constexpr std::size_t kLongestPattern = 256;

class Pattern {
 public:
  Pattern(std::string option, const std::string& text) : option_(std::move(option)), text_(text) {
    if (text.size() > kLongestPattern)
      throw std::invalid_argument(option_ + ": longer than " + std::to_string(kLongestPattern) +
                                  " letters");
    guarded([&] { regex_.assign(text); });
  }

  [[nodiscard]] bool matches(const std::string& name) const {
    bool found = false;
    guarded([&] { found = std::regex_search(name, regex_); });
    return found;
  }

 private:
  void guarded(auto&& action) const {
    try {
      action();
    } catch (const std::regex_error& error) {
      throw std::invalid_argument(option_ + ": '" + text_ +
                                  "' is no regular expression: " + error.what());
    }
  }

  std::string option_, text_;
  std::regex regex_;
};

void add_matching(const std::string& regex, std::set<std::string>& topics) {
  const Pattern pattern("--regex", regex);
  bool any = false;
  for (const idl::KnownTopic& topic : idl::known_topics()) {
    if (!pattern.matches(topic.name)) continue;
    topics.insert(topic.name);
    any = true;
  }
  if (!any) throw std::invalid_argument("--regex: '" + regex + "' matches no topic of the monitor");
}

}  // namespace

std::set<std::string> chosen_topics(const TopicChoice& choice,
                                    const std::vector<std::string>& by_default) {
  std::set<std::string> topics(choice.names.begin(), choice.names.end());
  if (!choice.regex.empty()) add_matching(choice.regex, topics);
  if (topics.empty()) topics.insert(by_default.begin(), by_default.end());
  for (const std::string& name : choice.exclude)
    if (topics.erase(name) == 0 && idl::find_known_topic(name) == nullptr)
      throw std::invalid_argument("--exclude-topics: there is no topic '" + name + "'");
  if (!choice.exclude_regex.empty()) {
    const Pattern pattern("--exclude-regex", choice.exclude_regex);
    std::erase_if(topics, [&](const std::string& name) { return pattern.matches(name); });
  }
  if (topics.empty()) throw std::invalid_argument("all topics chosen are excluded");
  return topics;
}

}  // namespace mpm::bag
