#include "idl/output_samples.hpp"

#include <cstdint>

#include "core/record/reason_text.hpp"

namespace mpm::idl {

void SampleMaker::put(const std::optional<std::string>& text, char*& sample) {
  sample = borrow(text ? text->c_str() : "");
}

void SampleMaker::put(const std::vector<double>& values, dds_sequence_double& sample) {
  const auto count = static_cast<std::uint32_t>(values.size());
  sample = {count, count, const_cast<double*>(values.data()), false};
}

void SampleMaker::put(const std::vector<CauseParameter>& values,
                      dds_sequence_mpm_CauseParameter& sample) {
  parameters_.clear();
  for (const CauseParameter& value : values)
    parameters_.push_back({borrow(value.name.c_str()), value.value, value.low, value.high});
  const auto count = static_cast<std::uint32_t>(parameters_.size());
  sample = {count, count, parameters_.data(), false};
}

void SampleMaker::put(const std::tuple<const Reason&, const std::string&>& reason, char*& sample) {
  reason_ = reason_text(std::get<0>(reason), std::get<1>(reason));
  sample = borrow(reason_.c_str());
}

void RecordMaker::take(const char* sample, std::optional<std::string>& text) {
  text = or_empty(sample);
  if (text->empty()) text.reset();
}

void RecordMaker::take(const dds_sequence_double& sample, std::vector<double>& values) {
  values.assign(sample._buffer, sample._buffer + sample._length);
}

void RecordMaker::take(const dds_sequence_mpm_CauseParameter& sample,
                       std::vector<CauseParameter>& values) {
  values.resize(sample._length);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const mpm_CauseParameter& parameter = sample._buffer[i];
    take(parameter.name, values[i].name);
    values[i].value = parameter.value;
    values[i].low = parameter.low;
    values[i].high = parameter.high;
  }
}

void RecordMaker::take(const char* sample, std::tuple<Reason&, std::string&> reason) {
  reason = parse_reason(or_empty(sample));
}

}  // namespace mpm::idl
