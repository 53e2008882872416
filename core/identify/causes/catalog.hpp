#pragma once

#include <string_view>
#include <vector>

#include "core/identify/causes/cause.hpp"

/// The table of causes, a row each; the file of that name holds all there is to it. What is
/// proposed, said, drawn and scored goes through this table alone.
// clang-format off
#define MPM_CAUSES(row)      \
  row(gain)                  \
  row(dead_time)             \
  row(time_constant)         \
  row(dynamics)              \
  row(input_scale)           \
  row(output_scale)          \
  row(input_polynomial)      \
  row(input_saturation)      \
  row(input_two_sided)       \
  row(input_product)         \
  row(deadband)              \
  row(stiction)              \
  row(input_stuck)           \
  row(input_offset)          \
  row(output_saturation)     \
  row(unmodelled_input)      \
  row(step_disturbance)      \
  row(drift_disturbance)     \
  row(periodic_disturbance)  \
  row(noise)                 \
  row(cubic_stiffness)       \
  row(square_root_outflow)   \
  row(coulomb_friction)      \
  row(unnamed_swing)         \
  row(unnamed_direction)
// clang-format on

namespace mpm::causes {

/// Each row as a function of its name: causes::gain(), ...
#define MPM_DECLARE(cause) [[nodiscard]] const Cause& cause();
MPM_CAUSES(MPM_DECLARE)
#undef MPM_DECLARE

/// All of them, in the order of the table.
[[nodiscard]] const std::vector<const Cause*>& all();

/// By the contract's words; null where there is none. `kind` empty: the first of that name.
[[nodiscard]] const Cause* find(std::string_view name, std::string_view kind = {});

/// Whether it is a name of the table for what has no name: never that of a finding.
[[nodiscard]] bool is_unnamed(const Cause& cause);

/// Whether it comes from outside the model, so that its channels may hold all the same: what
/// disturbs a CV, an offset of its sensor, its noise.
[[nodiscard]] bool is_from_outside(const Subject& subject);

}  // namespace mpm::causes
