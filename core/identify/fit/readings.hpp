#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_part.hpp"
#include "core/model/model_spec.hpp"

/// CVs that are read only every so many samples (an analyser's): what stands between two readings
/// would pass for dead time, swings and noise in bursts. They are looked at by their readings.
namespace mpm {

/// CVs that are read in one cycle.
struct Readings {
  double every = 1.0;           ///< rows, whole or not
  std::vector<double> offsets;  ///< of each run: where the first reading is (reading_offset)
  std::vector<int> cvs;         ///< ascending
};

/// All CVs of a recording that are read at every sample, then cycle by cycle those that keep to
/// one.
[[nodiscard]] std::vector<Readings> readings_of(const Recording& recording);

/// The same CVs in another recording; nothing where they are not read in the same cycle there.
[[nodiscard]] std::optional<Readings> readings_in(const Recording& other, const Readings& readings);

/// The part of a recording that these CVs (ascending) are.
[[nodiscard]] Recording of_cvs(const Recording& recording, const std::vector<int>& cvs);

/// The same at the readings of a cycle. A mean of what an input does between two readings is not
/// all of what a quick channel makes of it: by what the model itself (whole, in channels) comes out
/// otherwise at the longer sample time the CVs are put right, so that it fits as well as at its
/// own. No model where it cannot be had at that sample time (at_longer_sample_time), and no rows.
[[nodiscard]] std::optional<ModelSpec> of_readings(const ModelSpec& model,
                                                   const Readings& readings);
[[nodiscard]] Recording of_readings(const ModelSpec& model, const Recording& recording,
                                    const Readings& readings);

}  // namespace mpm
