#pragma once

#include <vector>

#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

/// CVs that are read only every so many samples (an analyser's): what stands between two readings
/// would pass for dead time, swings and noise in bursts. They take no part in a diagnosis beside
/// those that are measured at every sample.
namespace mpm {

/// The CVs that are measured at every sample, ascending.
[[nodiscard]] std::vector<int> read_at_every_sample(const Recording& recording);

/// The part of a model in channels, or of a recording, that these CVs (ascending) are.
[[nodiscard]] ModelSpec of_cvs(const ModelSpec& model, const std::vector<int>& cvs);
[[nodiscard]] Recording of_cvs(const Recording& recording, const std::vector<int>& cvs);

/// A part's model in channels, extended as it may be, within the whole.
[[nodiscard]] ModelSpec within(const ModelSpec& whole, const ModelSpec& part,
                               const std::vector<int>& cvs);

/// What the diagnosis of a part says, in the numbers of the whole. `model`: the whole, in channels;
/// `validation` may be null. CVs that had no part in it are simulated and scored, not judged.
void to_whole(const ModelSpec& model, const Recording& recording, const Recording* validation,
              const std::vector<int>& cvs, Diagnosis& diagnosis);

}  // namespace mpm
