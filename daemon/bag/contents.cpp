#include "daemon/bag/contents.hpp"

#include "config/finding.hpp"
#include "core/text/printable.hpp"
#include "daemon/bag/sample_stream.hpp"
#include "idl/layout_sample.hpp"

namespace mpm::bag {
namespace {

SignalKind kind_by_name(std::string_view name, bool& known) {
  known = true;
  for (const SignalKind kind : idl::kTopicKinds)
    if (name == idl::kind_name(kind)) return kind;
  known = name == "aux";
  return SignalKind::kAux;
}

}  // namespace

Contents contents_of(const std::vector<std::string>& paths,
                     const std::function<bool(const Contents&)>& enough) {
  Contents contents;
  SampleStream stream(paths);
  const auto unit_of = [&](std::string_view name) -> RecordedUnit& {
    const auto found = contents.find(name);
    if (found != contents.end()) return found->second;
    if (contents.size() >= kMostUnits)
      throw config::InputError({mcap::name_of(paths), 0, 0, config::Severity::kError, "",
                                "holds more than " + std::to_string(kMostUnits) + " units"});
    return contents[std::string(name)];
  };
  while (true) {
    const SampleStream::Event event = stream.next();
    if (event == SampleStream::Event::kEnd) return contents;
    if (event == SampleStream::Event::kLayout) {
      bool known = false;
      const SignalKind kind = kind_by_name(stream.layout().kind, known);
      if (!known) continue;
      RecordedUnit& unit = unit_of(stream.layout().unit);
      unit.sample_time_s = stream.layout().sample_time_s;
      unit[kind].tags = idl::texts_of(stream.layout().tags);
      unit[kind].engineering_units = idl::texts_of(stream.layout().engineering_units);
      continue;
    }
    RecordedKind& kind = unit_of(stream.sample().unit)[stream.sample().kind];
    if (kind.seen) continue;
    kind.seen = true;
    kind.width = static_cast<int>(stream.sample().values.size());
    if (enough(contents)) return contents;
  }
}

std::string names_of(const Contents& contents) {
  std::string text;
  for (const auto& [name, unit] : contents)
    text += (text.empty() ? "'" : ", '") + printable(name) + "'";
  return text;
}

}  // namespace mpm::bag
