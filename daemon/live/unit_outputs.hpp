#pragma once

#include "idl/output_writers.hpp"

namespace mpm::live {

/// What is said of one unit on the bus: nothing while another monitor speaks for it.
class UnitOutputs {
 public:
  explicit UnitOutputs(const idl::OutputWriters& writers) : writers_(writers) {}

  void be_silent(bool silent) { silent_ = silent; }
  [[nodiscard]] bool silent() const { return silent_; }
  /// False where it could not be handed over.
  template <class Record>
  [[nodiscard]] bool write(const Record& record) const {
    return silent_ || writers_.write(record);
  }

 private:
  const idl::OutputWriters& writers_;
  bool silent_ = false;
};

}  // namespace mpm::live
