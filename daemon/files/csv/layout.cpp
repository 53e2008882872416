#include "daemon/files/csv/layout.hpp"

#include <algorithm>
#include <functional>

#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/column_names.hpp"
#include "daemon/files/csv/tag_names.hpp"

namespace mpm::files {
namespace {

using Names = std::vector<Cell>;

bool names_signal(const TagTable* tags, std::string_view name) {
  return tags != nullptr && tags->find(name) != nullptr;
}

std::optional<std::size_t> find_if_name(const Names& header,
                                        const std::function<bool(std::string_view)>& is) {
  for (std::size_t i = 0; i < header.size(); ++i)
    if (is(header[i].text)) return i;
  return std::nullopt;
}

std::optional<std::size_t> find_best(const Names& header, int (*rank)(std::string_view)) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const int here = rank(header[i].text);
    if (here >= 0 && (!best || here < rank(header[*best].text))) best = i;
  }
  return best;
}

std::optional<TimeColumns> find_time(const Names& header, const TagTable* tags) {
  const auto free = [tags](std::string_view name) { return !names_signal(tags, name); };
  const auto date =
      find_if_name(header, [&](std::string_view name) { return free(name) && is_date_name(name); });
  const auto clock = find_if_name(
      header, [&](std::string_view name) { return free(name) && is_clock_name(name); });
  if (date && clock) return TimeColumns{*date, clock};
  auto time = find_if_name(header, [](std::string_view name) { return same_word(name, "time"); });
  if (!time)
    time = find_if_name(header,
                        [&](std::string_view name) { return free(name) && is_time_name(name); });
  if (!time && !header.empty() && is_short_time_name(header[0].text)) time = 0;
  return time ? std::optional(TimeColumns{*time, std::nullopt}) : std::nullopt;
}

/// Columns that are called as the same time; none where a time of day stands beside a date.
std::vector<std::size_t> repeated_times(const Names& header, const TagTable* tags) {
  std::vector<std::size_t> times;
  if (const auto time = find_time(header, tags); time && time->clock) return times;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string_view name = header[i].text;
    if (is_time_name(name) && !names_signal(tags, name) &&
        (times.empty() || plain_name(name) == plain_name(header[times.front()].text)))
      times.push_back(i);
  }
  return times;
}

/// A tag, a time and a value column.
std::optional<Layout> find_long(const Names& header, const TagTable* tags) {
  Layout layout;
  const auto tag = find_best(header, tag_name_rank);
  auto value = find_best(header, value_name_rank);
  if (!value) {  // a column for each type, of which one is filled
    for (std::size_t i = 0; i < header.size(); ++i)
      if (is_typed_value_name(header[i].text)) layout.others.push_back(i);
    if (!layout.others.empty()) value = layout.others.front();
  }
  std::optional<TimeColumns> time = find_time(header, tags);
  if (!time) {
    const auto brief = find_if_name(header, is_short_time_name);
    if (brief) time = TimeColumns{*brief, std::nullopt};
  }
  if (!tag || !value || !time) return std::nullopt;
  layout.is_long = true;
  layout.width = header.size();
  layout.time = *time;
  layout.tag = *tag;
  layout.value = *value;
  // One historian may tell its quality in several codes; the first of the table is the best known.
  const auto is_quality_code = [](std::string_view name) {
    return plain_name(name).find("quality") != std::string::npos;
  };
  std::optional<QualityColumn> code;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::optional<QualityKind> kind = quality_kind(header[i].text);
    if (!kind || i == *tag || i == *value) continue;
    const QualityColumn column{i, *value, *kind, false};
    if (!is_quality_code(header[i].text))
      layout.qualities.push_back(column);
    else if (!code || quality_rank(header[i].text) < quality_rank(header[code->cell].text))
      code = column;
  }
  if (code) layout.qualities.push_back(*code);
  return layout;
}

/// The tag that a column `FIC101.Quality`, `FIC101 Status`, `FIC101_Q` or `FIC101 (Quality)`
/// qualifies, and how; the tag is a column of its own, plainly or as `FIC101.Value`.
std::optional<QualityColumn> qualifies(const Names& header, std::size_t at) {
  std::string_view name = header[at].text;
  const bool bracket = !name.empty() && (name.back() == ')' || name.back() == ']');
  if (bracket) name.remove_suffix(1);
  for (std::size_t cut = name.size(); cut-- > 1;) {
    if (std::string_view(" ._-:/|([").find(name[cut]) == std::string_view::npos) continue;
    const std::optional<QualityKind> kind = quality_kind(name.substr(cut + 1));
    if (!kind) continue;
    std::string_view tag = name.substr(0, cut);
    while (!tag.empty() && tag.back() == ' ') tag.remove_suffix(1);
    for (std::size_t i = 0; i < header.size(); ++i)
      if (i != at && (header[i].text == tag || without_value_word(header[i].text) == tag))
        return QualityColumn{at, i, *kind, same_word(name.substr(cut), kQualitySuffix)};
  }
  return std::nullopt;
}

bool has_quality_suffix(std::string_view name) {
  return name.size() > kQualitySuffix.size() &&
         same_word(name.substr(name.size() - kQualitySuffix.size()), kQualitySuffix);
}

/// `Status`, and `Status.1` as some programs make names unlike.
std::optional<QualityKind> bare_quality(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot != std::string_view::npos &&
      name.find_first_not_of("0123456789", dot + 1) == std::string_view::npos)
    name = name.substr(0, dot);
  return quality_kind(name);
}

}  // namespace

Layout layout_with_time(const Names& header, TimeColumns time, const TagTable* tags) {
  Layout layout;
  layout.width = header.size();
  layout.time = time;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string_view name = header[i].text;
    if (i == time.time || (time.clock && i == *time.clock)) continue;
    if (name.empty()) {
      ++layout.without_name;
      continue;
    }
    if (!names_signal(tags, name)) {
      if (const std::optional<QualityColumn> column = qualifies(header, i)) {
        layout.qualities.push_back(*column);
        continue;
      }
      if (has_quality_suffix(name)) {
        layout.orphans.emplace_back(name);
        continue;
      }
      const std::optional<QualityKind> bare = bare_quality(name);
      if (bare && !layout.values.empty()) {
        layout.qualities.push_back({i, layout.values.back(), *bare, false});
        continue;
      }
    }
    layout.values.push_back(i);
  }
  return layout;
}

Layout layout_of_pairs(const Names& header, const std::vector<std::size_t>& times) {
  Layout layout;
  layout.width = header.size();
  layout.time = {times.front(), std::nullopt};
  const auto names_a_tag = [&header](std::size_t i) {
    return !header[i].text.empty() && value_name_rank(header[i].text) < 0;
  };
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::size_t time = times[k];
    const std::size_t end = k + 1 < times.size() ? times[k + 1] : header.size();
    const std::size_t first = layout.pairs.size();
    for (std::size_t i = time + 1; i < end; ++i) {
      const std::string_view name = header[i].text;
      if (name.empty() && i > time + 1) continue;
      const std::optional<QualityKind> quality = quality_kind(name);
      if (quality && layout.pairs.size() > first)
        layout.qualities.push_back({i, layout.pairs.back().value, *quality, false});
      else
        layout.pairs.push_back({time, i, names_a_tag(i) ? std::string(name) : std::string()});
    }
    if (layout.pairs.size() == first) layout.pairs.push_back({time, time + 1, {}});
    PairedColumns& pair = layout.pairs[first];
    if (pair.name.empty() && names_a_tag(time) && !is_time_name(header[time].text))
      pair.name = header[time].text;
    layout.width = std::max(layout.width, pair.value + 1);
  }
  return layout;
}

std::optional<Layout> find_layout(const std::vector<Cell>& cells, const TagTable* tags) {
  Names header = cells;
  if (header.size() > 1 && header.back().text.empty()) header.pop_back();  // a delimiter at the end
  if (std::optional<Layout> layout = find_long(header, tags)) return layout;
  if (const std::vector<std::size_t> times = repeated_times(header, tags); times.size() > 1)
    return layout_of_pairs(header, times);
  const std::optional<TimeColumns> time = find_time(header, tags);
  return time ? std::optional(layout_with_time(header, *time, tags)) : std::nullopt;
}

}  // namespace mpm::files
