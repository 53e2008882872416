#include "daemon/bag/mcap_recording.hpp"

#include <algorithm>
#include <limits>

#include "config/unit_layout.hpp"
#include "daemon/bag/kind_name.hpp"
#include "daemon/bag/sample_stream.hpp"
#include "idl/topic_catalog.hpp"

namespace mpm::bag {
namespace {

// No process waits for these messages, so a chunk may span any time.
mcap::WriterOptions options() {
  mcap::WriterOptions options;
  options.chunk_age_ns = std::numeric_limits<std::int64_t>::max();
  return options;
}

/// Borrows `texts`; `pointers` is the memory of the result.
dds_sequence_string borrowed(std::vector<std::string>& texts, std::vector<char*>& pointers) {
  pointers.clear();
  for (std::string& text : texts) pointers.push_back(text.data());
  const auto count = static_cast<std::uint32_t>(texts.size());
  return {count, count, pointers.data(), false};
}

}  // namespace

McapRecording::McapRecording(const std::string& path, const config::UnitConfig& unit,
                             const std::vector<files::Column>& columns)
    : writer_(path, options()), unit_(unit) {
  const SignalCounts counts = unit.counts();
  for (const files::Column& column : columns) {
    std::vector<std::string>& tags = tags_[static_cast<std::size_t>(column.kind)];
    tags.resize(static_cast<std::size_t>(counts.of(column.kind)));
    tags[static_cast<std::size_t>(column.index)] = column.tag;
  }
  const mcap::SchemaId layout = writer_.add_schema("mpm::Layout", "omgidl", idl::idl_text());
  const mcap::SchemaId sample = writer_.add_schema("mpm::Sample", "omgidl", idl::idl_text());
  layouts_ = writer_.add_channel(layout, idl::kLayoutTopic, "cdr");
  for (std::size_t k = 0; k < kSignalKindCount; ++k)
    if (!tags_[k].empty())
      channels_[k] = writer_.add_channel(sample, topic_of(static_cast<SignalKind>(k)), "cdr");
}

void McapRecording::write_layouts(std::int64_t time_ns) {
  idl::CdrEncoder<mpm_Layout> layouts;
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    if (!channels_[k]) continue;
    const auto kind = static_cast<SignalKind>(k);
    std::vector<std::string> units = engineering_units_of(unit_, kind);
    std::string kind_text = name_of(kind);
    std::vector<char*> tag_pointers, unit_pointers;
    mpm_Layout layout{};
    layout.unit = unit_.unit.data();
    layout.kind = kind_text.data();
    layout.sample_time_s = unit_.sample_time_s;
    layout.tags = borrowed(tags_[k], tag_pointers);
    layout.engineering_units = borrowed(units, unit_pointers);
    writer_.write(layouts_, time_ns, time_ns, layouts.encode(layout));
  }
}

void McapRecording::write(const Frame& frame) {
  // A row that goes back in time keeps its place: it was received after the one before.
  log_time_ns_ = begun_ ? std::max(log_time_ns_, frame.source_time_ns) : frame.source_time_ns;
  if (!begun_) write_layouts(log_time_ns_);
  begun_ = true;
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    if (!channels_[k]) continue;
    const auto kind = static_cast<SignalKind>(k);
    mpm_Sample sample = idl::sample_of(unit_.unit.c_str(), frame, kind);
    const std::vector<Quality>& quality = frame[kind].quality;
    if (std::all_of(quality.begin(), quality.end(), [](Quality q) { return q == Quality::kGood; }))
      sample.quality._length = 0;
    writer_.write(*channels_[k], log_time_ns_, frame.source_time_ns, samples_.encode(sample));
  }
}

}  // namespace mpm::bag
