#include "config/suggest.hpp"

#include <algorithm>
#include <cstddef>

namespace mpm::config {
namespace {

constexpr std::size_t kLongestCompared = 256;  // tags have at most 128 bytes
constexpr std::size_t kShortList = 20;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  a = a.substr(0, kLongestCompared);
  b = b.substr(0, kLongestCompared);
  std::vector<int> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char x = lower(a[i - 1]);
      const char y = lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (x == y ? 0 : 1)});
      if (i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y)
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

const std::string* closest(std::string_view word, const std::vector<std::string>& known) {
  int best = 1 + std::max(1, static_cast<int>(word.size()) / 3);  // one too far
  const std::string* found = nullptr;
  for (const std::string& candidate : known) {
    const int distance = edit_distance(word, candidate);
    // Half of the word must be right, or `u` would be a likely slip for every one-letter name.
    if (distance < best && 2 * distance <= static_cast<int>(candidate.size())) {
      best = distance;
      found = &candidate;
    }
  }
  return found;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  if (const std::string* likely = closest(word, known)) return " (did you mean '" + *likely + "'?)";
  std::vector<std::string> named;  // a tag that could not be read is empty
  for (const std::string& candidate : known)
    if (!candidate.empty()) named.push_back(candidate);
  if (!named.empty() && named.size() <= kShortList)
    return " (known: " + join(named, kShortList) + ")";
  return {};
}

std::string join(const std::vector<std::string>& words, std::size_t limit) {
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), limit); ++i)
    text += (i > 0 ? ", " : "") + words[i];
  if (words.size() > limit) text += " ... (" + std::to_string(words.size() - limit) + " more)";
  return text;
}

}  // namespace mpm::config
