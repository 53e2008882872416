#include "idl/output_readers.hpp"

#include "idl/layout_sample.hpp"

namespace mpm::idl {

LayoutRecord layout_record(const mpm_Layout& sample) {
  return {sample.unit == nullptr ? "" : sample.unit, sample.kind == nullptr ? "" : sample.kind,
          texts_of(sample.tags)};
}

}  // namespace mpm::idl
