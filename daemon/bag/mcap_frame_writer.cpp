#include "daemon/bag/mcap_frame_writer.hpp"

#include <algorithm>
#include <limits>

#include "config/unit_layout.hpp"
#include "daemon/bag/kind_name.hpp"
#include "daemon/bag/sample_stream.hpp"
#include "idl/layout_sample.hpp"
#include "idl/topic_catalog.hpp"

namespace mpm::bag {
namespace {

// No process waits for these messages, so a chunk may span any time.
mcap::WriterOptions options() {
  mcap::WriterOptions options;
  options.chunk_age_ns = std::numeric_limits<std::int64_t>::max();
  return options;
}

}  // namespace

McapFrameWriter::McapFrameWriter(const mcap::OutputPlace& place, const config::UnitConfig& unit,
                                 const std::vector<files::Column>& columns)
    : writer_(place, options()), unit_(unit) {
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

void McapFrameWriter::write_layouts(std::int64_t time_ns) {
  idl::CdrEncoder<mpm_Layout> layouts;
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    if (!channels_[k]) continue;
    const auto kind = static_cast<SignalKind>(k);
    const SignalLayout signals{tags_[k], engineering_units_of(unit_, kind)};
    const idl::LayoutSample layout(unit_.unit, name_of(kind), unit_.sample_time_s, signals);
    writer_.write(layouts_, time_ns, time_ns, layouts.encode(layout.get()));
  }
}

void McapFrameWriter::write(const Frame& frame) {
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
