#pragma once

#include "core/identify/diagnosis/diagnosis.hpp"

namespace mpm {

/// Fits count time by rows. Makes the moments in `diagnosis`, of findings and of what the extended
/// model has beyond `given`, those of the clock of the data.
void tell_on_clock(const Recording& recording, const ModelSpec& given, Diagnosis& diagnosis);

}  // namespace mpm
