#include "daemon/bag/list_text.hpp"

#include <algorithm>
#include <array>

#include "core/signal/saturated.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/bag/info_text.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::bag {
namespace {

constexpr std::size_t kColumns = 6;  // and whether it is whole
using Row = std::array<std::string, kColumns + 1>;

double length_s(const ListedRecording& recording) {
  return static_cast<double>(saturated_difference(*recording.end_ns, *recording.start_ns)) / 1e9;
}

Row row_of(const ListedRecording& recording) {
  Row row;
  row[0] = printable(recording.name);
  row[1] = "-";
  row[2] = "-";
  if (recording.start_ns) {
    row[1] = files::formatted_utc(*recording.start_ns / 1'000'000'000, "%Y-%m-%dT%H:%M:%SZ");
    row[2] = duration_text(length_s(recording));
  }
  row[3] = bytes_text(recording.bytes);
  row[4] = counted(recording.messages, "message");
  for (const std::string& unit : recording.units)
    row[5] += (row[5].empty() ? "" : ",") + printable(unit);
  if (row[5].empty()) row[5] = "-";
  row[6] = recording.problem.empty() ? "whole" : "NOT WHOLE: " + printable(recording.problem, 1000);
  return row;
}

}  // namespace

nlohmann::ordered_json to_json(const std::vector<ListedRecording>& list) {
  auto json = nlohmann::ordered_json::array();
  for (const ListedRecording& recording : list) {
    nlohmann::ordered_json entry;
    entry["name"] = recording.name;
    entry["files"] = recording.files;
    if (recording.start_ns) {
      entry["start"] = files::utc_text(*recording.start_ns);
      entry["end"] = files::utc_text(*recording.end_ns);
      entry["duration_s"] = length_s(recording);
    }
    entry["bytes"] = recording.bytes;
    entry["messages"] = recording.messages;
    entry["units"] = recording.units;
    entry["whole"] = recording.problem.empty();
    if (!recording.problem.empty()) entry["problem"] = recording.problem;
    json.push_back(std::move(entry));
  }
  return json;
}

std::string to_text(const std::vector<ListedRecording>& list) {
  std::vector<Row> rows;
  std::array<std::size_t, kColumns> widths{};
  for (const ListedRecording& recording : list) {
    rows.push_back(row_of(recording));
    for (std::size_t i = 0; i < kColumns; ++i)
      widths[i] = std::max(widths[i], rows.back()[i].size());
  }
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kColumns; ++i)
      text += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
    text += row[kColumns] + '\n';
  }
  return text;
}

}  // namespace mpm::bag
