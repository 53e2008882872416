#pragma once

#include <string>

#include "config/unit_config.hpp"
#include "core/identify/diagnosis.hpp"

namespace mpm::report {

/// Tags and engineering units for the indices of a diagnosis. Inputs beyond the model's own are the
/// aux signals that the extended model takes.
class SignalNames {
 public:
  SignalNames(const config::UnitConfig& unit, const Diagnosis& diagnosis)
      : unit_(unit), new_inputs_(diagnosis.new_inputs) {}

  [[nodiscard]] const std::string& cv(int index) const;
  [[nodiscard]] const std::string& input(int index) const;
  [[nodiscard]] const std::string& aux(int index) const;
  /// The tag of what acts: input or aux; empty where the cause has none.
  [[nodiscard]] std::string source(const Subject& subject) const;
  /// "gain of u1 -> y1", "output_disturbance (step) on y2"
  [[nodiscard]] std::string subject(const Subject& subject) const;

  /// "0.25 %": a number with the unit of the signal, as far as the unit file names one.
  [[nodiscard]] std::string in_cv(double value, int cv) const;
  [[nodiscard]] std::string in_source(double value, const Subject& subject) const;
  [[nodiscard]] const std::string& cv_unit(int index) const;
  [[nodiscard]] const std::string& source_unit(const Subject& subject) const;

 private:
  [[nodiscard]] const config::InputSignal& input_signal(int index) const;

  const config::UnitConfig& unit_;
  std::vector<int> new_inputs_;
};

}  // namespace mpm::report
