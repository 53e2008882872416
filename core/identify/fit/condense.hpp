#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// How fast a plant answers, s.
struct PlantSpeed {
  double fastest_s = 0.0;  ///< least of the channels' slowest time constants
  double slowest_s = 0.0;  ///< greatest of them
};

/// Of a model's channels, those that integrate left out; 0 where there is none.
[[nodiscard]] PlantSpeed speed_of(const ModelSpec& model);

/// Whether its numbers are in seconds, and means of what moves are what acts: transfer functions
/// alone, for behind a valve's block the mean is not that before it.
[[nodiscard]] bool holds_at_any_sample_time(const ModelSpec& model);
/// No curves before its channels, no tanks, no terms of a CV's own.
[[nodiscard]] bool is_linear(const ModelSpec& model);

/// Of each run from its row `offsets` on `every` rows as one, t(K) = t(floor(offset + K every)):
/// MVs, DVs and aux are means over what acts from there to the next one, CVs and set-points what
/// was read at t(K), so that no answer comes late and no input acts before its time. Runs of which
/// no row is left go.
[[nodiscard]] Recording averaged(const Recording& recording, double every,
                                 const std::vector<double>& offsets);

/// What of a long recording is used.
struct Condensing {
  Eigen::Index given = 0;      ///< rows that there are
  Eigen::Index every = 1;      ///< of them, averaged into one
  Eigen::Index stretches = 0;  ///< that were chosen; 0: all of the recording is used

  [[nodiscard]] bool any() const { return every > 1 || stretches > 0; }
};

struct Condensed {
  Recording recording;
  Condensing how;
  std::vector<std::size_t> run_of;  ///< of each run, the given one that it is part of
};

/// Rows of which one becomes where all of a recording is to be used, in `most_rows` rows at most.
[[nodiscard]] Eigen::Index rows_to_average(const Recording& recording, Eigen::Index most_rows);

/// Rows of which one becomes, for a recording of more than `most_rows`: as few as let so many rows
/// span many of the slowest time constant, yet several rows the fastest; whole control intervals of
/// the inputs where these are held for several rows. A shorter recording is left as it is: 1.
[[nodiscard]] Eigen::Index rows_to_average(const Recording& recording, const PlantSpeed& speed,
                                           Eigen::Index most_rows);

/// The same for a model: 1 where it holds at its own sample time alone.
[[nodiscard]] Eigen::Index rows_to_average(const Recording& recording, const ModelSpec& model,
                                           Eigen::Index most_rows);

/// A recording that a fit can bear. First `every` rows become one (`averaged`). Rows begin where
/// inputs that are held for several rows move. Then, if more than `most_rows` are left, of each of
/// some equal spans the stretch in which set-points move most, or inputs where no set-point moves,
/// as a run of its own: at its own level and from its own first state. Nothing is done to a
/// recording that is short enough where `every` is 1.
[[nodiscard]] Condensed condensed(const Recording& recording, Eigen::Index every,
                                  Eigen::Index most_rows);

}  // namespace mpm
