#pragma once

#include <Eigen/Core>
#include <optional>

namespace mpm {

/// What a historian or a converter has left of a signal. Units are the signal's own.
struct HistorianTraits {
  double held_share = 0.0;      ///< of the known rows, 0..1: exactly equal to the row before
  double straight_share = 0.0;  ///< that lie on a straight line between neighbours and move
  /// By exception: after a hold the signal moves by at least this; 0 = none seen.
  double deadband = 0.0;
  /// Of a lattice that all values lie on and whose neighbours most moves go between: a converter
  /// coarser than what it measures moves by from row to row; 0 = none seen.
  double quantum = 0.0;
  /// An analyser's: rows from one reading to the next as a rule, between which it stands or nothing
  /// is known; 0 = it is no reading of every so many rows.
  Eigen::Index read_every = 0;
  bool interpolated = false;  ///< straight lines between archived points, with corners
  double sd = 0.0;            ///< of the known values

  [[nodiscard]] bool compressed() const { return deadband > 0.0 || interpolated; }
};

/// Looks at one column, NaN where unknown. A signal that rests by nature is none of these: one of
/// few levels (a test signal), one that moves by any size after a rest (an operator, a controller
/// of a slower cycle), and one that is smooth.
[[nodiscard]] HistorianTraits historian_traits(const Eigen::Ref<const Eigen::VectorXd>& values);

/// `read_every` of a column.
[[nodiscard]] Eigen::Index reading_interval(const Eigen::Ref<const Eigen::VectorXd>& values);

/// The same to a part of a row: a whole number where the readings keep to one, else what their rows
/// rise by from one to the next.
[[nodiscard]] double reading_cycle(const Eigen::Ref<const Eigen::VectorXd>& values);

/// Of a column with one reading in `every` rows: where its cycle begins, rows in [0, every): by row
/// floor(offset + k every) the k-th reading is there, new or no more than a row old. Nothing where
/// the readings keep to no such cycle.
[[nodiscard]] std::optional<double> reading_offset(const Eigen::Ref<const Eigen::VectorXd>& values,
                                                   double every);

/// Whether what was lost is no longer small beside what the signal does, so that no cause can be
/// told from it: half of the rows were drawn by the historian, or a deadband or a quantum is more
/// than half an s.d. of the signal.
[[nodiscard]] bool beyond_use(const HistorianTraits& traits);

}  // namespace mpm
