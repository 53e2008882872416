#include "idl/sample_view.hpp"

namespace mpm::idl {

SampleView view_of(SignalKind kind, const mpm_Sample& sample, std::uint64_t writer) {
  return {kind,
          sample.unit == nullptr ? std::string_view() : std::string_view(sample.unit),
          sample.interval,
          sample.source_time_ns,
          {sample.values._buffer, sample.values._length},
          {sample.quality._buffer, sample.quality._length},
          writer};
}

mpm_Sample sample_of(const char* unit, const Frame& frame, SignalKind kind) {
  static_assert(sizeof(Quality) == sizeof(std::uint8_t));
  const SignalBlock& block = frame[kind];
  const auto count = static_cast<std::uint32_t>(block.size());
  // The C type has no const; writing does not touch what it points to.
  mpm_Sample sample{};
  sample.unit = const_cast<char*>(unit);
  sample.interval = frame.interval;
  sample.source_time_ns = frame.source_time_ns;
  sample.values = {count, count, const_cast<double*>(block.values.data()), false};
  sample.quality = {
      count, count,
      const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(block.quality.data())),
      false};
  return sample;
}

}  // namespace mpm::idl
