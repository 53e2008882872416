#include "idl/cdr.hpp"

#include <algorithm>
#include <functional>
#include <span>
#include <string>

#include "daemon/bus/sample_json.hpp"
#include "daemon/report/record_json.hpp"
#include "idl/output_samples.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {
namespace {

using Payload = std::span<const std::byte>;

/// What is read is written, and reads back to the same bytes.
template <class Sample>
const Sample* read(Payload payload) {
  static idl::CdrDecoder<Sample> decoder;
  static idl::CdrDecoder<Sample> again;
  static idl::CdrEncoder<Sample> encoder;
  const Sample* sample = decoder.decode(payload);
  if (sample == nullptr) return nullptr;
  const Payload written = encoder.encode(*sample);
  const std::vector<std::byte> once(written.begin(), written.end());
  const Sample* back = again.decode(once);
  require(back != nullptr, "what was written is no sample");
  require(std::ranges::equal(encoder.encode(*back), once), "what was written reads differently");
  return sample;
}

template <class Sample>
void show(Payload payload) {
  if (const Sample* sample = read<Sample>(payload))
    static_cast<void>(report::json_text(bus::json_of(*sample)));
}

template <class Record>
void tell(Payload payload) {
  const auto* sample = read<idl::SampleOf<Record>>(payload);
  if (sample == nullptr) return;
  const Record record = idl::record_of<Record>(*sample);
  static_cast<void>(report::json_text(report::json_of(record)));
  idl::SampleMaker maker;
  static_cast<void>(maker.sample_of(record));
}

}  // namespace

void cdr(std::string_view bytes) {
  static const std::vector<void (*)(Payload)> topics = {
      show<mpm_Sample>,        show<mpm_Layout>,        tell<ChannelRecord>,
      tell<AlarmStateRecord>,  tell<AlarmRecord>,       tell<ControllerAlarmRecord>,
      tell<HealthRecord>,      tell<PerformanceRecord>, tell<CommandRecord>,
      tell<CommandReplyRecord>};
  if (bytes.empty()) return;
  topics[static_cast<unsigned char>(bytes[0]) % topics.size()](
      std::as_bytes(std::span(bytes.substr(1))));
}

}  // namespace mpm::fuzz
