#include "daemon/bag/table.hpp"

#include <algorithm>
#include <utility>

#include "config/finding.hpp"
#include "config/suggest.hpp"
#include "config/unit_layout.hpp"
#include "daemon/bag/contents.hpp"
#include "daemon/bag/mcap_frames.hpp"
#include "daemon/bag/refuse.hpp"
#include "daemon/files/csv/csv_reader.hpp"
#include "daemon/files/csv/csv_rows.hpp"
#include "daemon/mcap/read/file_sequence.hpp"

namespace mpm::bag {
namespace {

/// The signals of the unit for which `holds(kind, index, tag)`.
template <class Holds>
std::vector<files::Column> columns_of(const config::UnitConfig& unit, Holds holds) {
  std::vector<files::Column> columns;
  for (const SignalKind kind :
       {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv, SignalKind::kPrediction,
        SignalKind::kSetpoint, SignalKind::kAux, SignalKind::kRaw}) {
    const std::vector<std::string> tags = tags_of(unit, kind);
    for (std::size_t i = 0; i < tags.size(); ++i)
      if (!tags[i].empty() && holds(kind, i, tags[i]))
        columns.push_back({tags[i], kind, static_cast<int>(i)});
  }
  return columns;
}

/// A unit that has the signals of the recorded layouts.
config::UnitConfig unit_of(const std::string& path, const std::string& name,
                           const RecordedUnit& recorded) {
  config::UnitConfig unit;
  unit.unit = name;
  if (recorded.sample_time_s > 0.0) unit.sample_time_s = recorded.sample_time_s;
  const auto tags = [&](SignalKind kind) {
    const RecordedKind& known = recorded[kind];
    if (known.seen && known.tags.size() != static_cast<std::size_t>(known.width))
      refuse(path, std::string("has no layout that names the ") + std::to_string(known.width) +
                       " signals of " + topic_of(kind) + "; give the unit file with --config");
    return known.seen ? known.tags : std::vector<std::string>();
  };
  const auto inputs = [&](SignalKind kind, std::vector<config::InputSignal>& signals) {
    for (std::string& tag : tags(kind)) signals.push_back({std::move(tag), "", ""});
  };
  inputs(SignalKind::kMv, unit.mv);
  inputs(SignalKind::kDv, unit.dv);
  inputs(SignalKind::kAux, unit.aux);
  inputs(SignalKind::kRaw, unit.raw);
  const std::vector<std::string> cvs = tags(SignalKind::kCv);
  const std::vector<std::string> predictions = tags(SignalKind::kPrediction);
  const std::vector<std::string> setpoints = tags(SignalKind::kSetpoint);
  unit.cv.resize(std::max({cvs.size(), predictions.size(), setpoints.size()}));
  for (std::size_t i = 0; i < unit.cv.size(); ++i) {
    if (i < cvs.size()) unit.cv[i].tag = cvs[i];
    if (i < predictions.size()) unit.cv[i].prediction = predictions[i];
    if (i < setpoints.size()) unit.cv[i].setpoint = setpoints[i];
  }
  return unit;
}

Table open_mcap(const std::string& path, const TableOptions& options) {
  const Contents contents = contents_of({path}, [](const Contents&) { return false; });
  const std::string wanted = options.unit != nullptr ? options.unit->unit : options.unit_name;
  if (contents.empty()) refuse(path, "holds no samples of any unit");
  if (wanted.empty() && contents.size() > 1)
    refuse(path, "holds several units; pick one with --unit: " + names_of(contents));
  const auto found = wanted.empty() ? contents.begin() : contents.find(wanted);
  if (found == contents.end())
    refuse(path, "holds no samples of unit '" + wanted + "'; its units are " + names_of(contents));
  const RecordedUnit& recorded = found->second;
  Table table;
  table.unit = options.unit != nullptr ? *options.unit : unit_of(path, found->first, recorded);
  table.columns = columns_of(table.unit, [&](SignalKind kind, std::size_t index, const auto& tag) {
    const RecordedKind& known = recorded[kind];
    if (table.unit.calculation_of(tag) != nullptr) return true;
    return known.seen && (index >= known.tags.size() || !known.tags[index].empty());
  });
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    const auto kind = static_cast<SignalKind>(k);
    if (recorded[kind].seen && table.unit.counts().of(kind) == 0)
      table.notices.push_back(std::string(topic_of(kind)) +
                              " left out: the unit file has no such signals");
  }
  table.frames = std::make_unique<McapFrames>(std::vector{path}, table.unit, files::Purpose::kKeep);
  return table;
}

Table open_csv(const std::string& path, const TableOptions& options) {
  Table table;
  if (options.unit != nullptr && options.number) {
    table.unit = *options.unit;
    auto reader =
        std::make_unique<files::CsvReader>(path, table.unit, options.times, files::Purpose::kKeep);
    // As a bus would have it: what reads the recording calculates the rest.
    table.columns = columns_of(table.unit, [&](SignalKind, std::size_t, const std::string& tag) {
      return reader->holds(tag) && table.unit.calculation_of(tag) == nullptr;
    });
    table.frames = std::move(reader);
    return table;
  }
  auto rows = std::make_unique<files::CsvRows>(path, options.times, options.unit);
  table.columns = rows->columns();
  table.frames = std::move(rows);
  if (options.unit == nullptr) return table;
  // Only what the unit names; the frames keep all.
  std::vector<files::Column> named;
  std::vector<std::string> others;
  for (const files::Column& column : columns_of(*options.unit, [](auto...) { return true; })) {
    const auto found =
        std::find_if(table.columns.begin(), table.columns.end(),
                     [&](const files::Column& have) { return have.tag == column.tag; });
    if (found != table.columns.end()) named.push_back(*found);
  }
  if (named.empty()) refuse(path, "holds no signal of unit '" + options.unit->unit + "'");
  for (const files::Column& column : table.columns)
    if (std::none_of(named.begin(), named.end(),
                     [&](const files::Column& taken) { return taken.tag == column.tag; }))
      others.push_back(column.tag);
  if (!others.empty())
    table.notices.push_back("left out, since the unit file does not name them: " +
                            config::join(others));
  table.columns = std::move(named);
  return table;
}

}  // namespace

Table open_table(const std::string& path, const TableOptions& options) {
  return mcap::is_recording(path) ? open_mcap(path, options) : open_csv(path, options);
}

}  // namespace mpm::bag
