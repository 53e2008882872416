#include "idl/output_readers.hpp"

namespace mpm::idl {

LayoutRecord layout_record(const mpm_Layout& sample) {
  LayoutRecord record{
      sample.unit == nullptr ? "" : sample.unit, sample.kind == nullptr ? "" : sample.kind, {}};
  for (std::uint32_t i = 0; i < sample.tags._length; ++i)
    record.tags.emplace_back(sample.tags._buffer[i] == nullptr ? "" : sample.tags._buffer[i]);
  return record;
}

}  // namespace mpm::idl
