#include "daemon/bag/convert.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "config/finding.hpp"
#include "config/replacement_file.hpp"
#include "daemon/bag/mcap_frame_writer.hpp"
#include "daemon/bag/refuse.hpp"
#include "daemon/mcap/read/file_sequence.hpp"

namespace mpm::bag {
namespace {

void count(const Frame& frame, const std::vector<files::Column>& columns, ConvertReport& report) {
  if (report.rows++ == 0) report.first_ns = report.last_ns = frame.source_time_ns;
  report.first_ns = std::min(report.first_ns, frame.source_time_ns);
  report.last_ns = std::max(report.last_ns, frame.source_time_ns);
  for (const files::Column& column : columns) {
    const SignalBlock& block = frame[column.kind];
    if (!std::isfinite(block.values(column.index))) {
      ++report.missing;
      continue;
    }
    ++report.values;
    const Quality quality = block.quality[static_cast<std::size_t>(column.index)];
    report.uncertain += quality == Quality::kUncertain ? 1 : 0;
    report.bad += quality == Quality::kBad ? 1 : 0;
  }
}

/// Which columns of a wide file need one for the quality: known only when all was read.
std::vector<bool> find_qualities(const std::string& input, const TableOptions& options,
                                 const files::TimeChoice& choice) {
  const Table table = open_table(input, options);
  std::vector<bool> needed(table.columns.size());
  Frame frame;
  while (table.frames->next(frame)) {
    if (!choice.takes(frame.source_time_ns)) continue;
    for (std::size_t i = 0; i < needed.size(); ++i)
      needed[i] =
          needed[i] || files::needs_quality(frame[table.columns[i].kind], table.columns[i].index);
  }
  return needed;
}

template <class Writer>
void copy(const Table& table, const files::TimeChoice& choice, Writer& writer,
          ConvertReport& report) {
  Frame frame(table.unit.counts());
  std::int64_t first_ns = 0, last_ns = 0;
  bool any = false;
  while (table.frames->next(frame)) {
    last_ns = frame.source_time_ns;
    if (!std::exchange(any, true)) first_ns = last_ns;
    if (!choice.takes(last_ns)) continue;
    count(frame, table.columns, report);
    writer.write(frame);
  }
  if (any && report.rows == 0)
    throw std::invalid_argument(files::nothing_chosen(first_ns, last_ns));
  writer.finish();
}

}  // namespace

ConvertReport convert(const std::string& input, const std::string& output,
                      const ConvertOptions& options) {
  const bool from_mcap = mcap::is_recording(input);
  const bool to_mcap = output.ends_with(".mcap");
  if (from_mcap && to_mcap) refuse(output, "both are MCAP files; there is nothing to convert");
  if (to_mcap && !options.unit)
    refuse(input, "give the unit file with --config: it tells which topic each tag belongs to");
  std::optional<config::ReplacementFile> file;  // standard output is none
  if (output != files::kStandardOutput) {
    config::refuse_to_replace({input}, output);
    file.emplace(output);
  }
  const TableOptions table_options{options.unit ? &*options.unit : nullptr, options.unit_name,
                                   options.input_times, to_mcap};
  ConvertReport report;
  try {
    files::CsvOptions csv{options.layout, options.seconds, options.output_zone, {}};
    if (!to_mcap && options.layout == files::CsvLayout::kWide)
      csv.quality = find_qualities(input, table_options, options.choice);
    const Table table = open_table(input, table_options);
    report.signals = table.columns.size();
    if (to_mcap) {
      McapFrameWriter writer({file->temporary(), file->descriptor()}, table.unit, table.columns);
      copy(table, options.choice, writer, report);
    } else {
      files::CsvWriter writer(file ? file->stream() : std::cout, file ? output : "standard output",
                              table.columns, std::move(csv));
      copy(table, options.choice, writer, report);
      report.bytes = writer.bytes_written();
    }
    report.notices = table.notices;
    report.notices.insert(report.notices.end(), table.frames->notices().begin(),
                          table.frames->notices().end());
    if (from_mcap)
      report.notices.emplace_back(
          "the numbers of the control intervals, times of arrival and engineering units are left "
          "out: a CSV has no place for them");
  } catch (const std::invalid_argument& error) {  // what the input holds does not fit the output
    refuse(input, error.what());
  }
  if (report.rows == 0) refuse(input, "holds no rows");
  if (!file) return report;
  report.bytes = file->bytes();
  file->commit();
  return report;
}

}  // namespace mpm::bag
