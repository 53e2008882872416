#include "daemon/bag/contents.hpp"

#include "config/finding.hpp"
#include "daemon/bag/sample_stream.hpp"
#include "daemon/mcap/printable.hpp"

namespace mpm::bag {
namespace {

constexpr std::size_t kMostUnits = 10'000;

std::vector<std::string> texts_of(const dds_sequence_string& texts) {
  return {texts._buffer, texts._buffer + texts._length};
}

SignalKind kind_by_name(std::string_view name, bool& known) {
  known = true;
  for (const SignalKind kind : idl::kTopicKinds)
    if (name == idl::kind_name(kind)) return kind;
  known = name == "aux";
  return SignalKind::kAux;
}

}  // namespace

Contents survey(const std::vector<std::string>& paths,
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
      unit[kind].tags = texts_of(stream.layout().tags);
      unit[kind].engineering_units = texts_of(stream.layout().engineering_units);
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
    text += (text.empty() ? "'" : ", '") + mcap::printable(name) + "'";
  return text;
}

}  // namespace mpm::bag
