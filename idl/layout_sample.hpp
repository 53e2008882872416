#pragma once

#include <string>
#include <vector>

#include "core/signal/unit_layout.hpp"
#include "mpm.h"

namespace mpm::idl {

/// An mpm::Layout, ready to be written, that borrows its texts.
class LayoutSample {
 public:
  /// Both texts and `signals` must outlive it. Engineering units that are not given are empty.
  LayoutSample(const std::string& unit, const char* kind, double sample_time_s,
               const SignalLayout& signals);
  LayoutSample(const LayoutSample&) = delete;
  LayoutSample& operator=(const LayoutSample&) = delete;

  [[nodiscard]] const mpm_Layout& get() const { return sample_; }

 private:
  std::vector<char*> tags_, engineering_units_;
  mpm_Layout sample_{};
};

/// False where a text is missing, which no writer of ours does.
[[nodiscard]] bool complete(const mpm_Layout& layout);
/// The texts of a sequence; one that is missing is empty.
[[nodiscard]] std::vector<std::string> texts_of(const dds_sequence_string& sequence);

}  // namespace mpm::idl
