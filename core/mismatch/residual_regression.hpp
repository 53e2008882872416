#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/noise_level.hpp"
#include "core/mismatch/regression_history.hpp"
#include "core/mismatch/regression_memory.hpp"
#include "core/mismatch/volterra_terms.hpp"
#include "core/regression/row_batch.hpp"

namespace mpm {

class Archive;

/// Room for rows that are taken together; the CVs share one.
struct RowWorkspace {
  /// `capacity`: rows (>= 1).
  RowWorkspace(int columns, int capacity);

  RowBatch rows;     ///< as they are
  RowBatch weighed;  ///< consumed by the factors
  std::vector<int> ages;
  std::vector<double> shares;
  std::vector<GivensQr::Preview> previews;
};

/// One CV's residual, regressed on the rows of `RegressionHistory` over several memories at once.
/// Every row is weighed by its own prediction error (`NoiseLevel`), that of the first memory, and
/// taken into the factor of each memory.
///
/// Once there are rows enough, new ones wait for each other and are taken together (`fold`), which
/// loads a factor once for all of them. The prediction that weighs a row is that of the rows before
/// the first one that waits with it.
class ResidualRegression {
 public:
  /// `lengths`: the first one is the longest. `remembered`: samples from which it can start afresh.
  ResidualRegression(const RegressionShape& shape, int cv, const std::vector<MemoryLength>& lengths,
                     int remembered);

  /// Takes these terms in from now on, as columns behind the lead-in, and begins with all samples
  /// that it rests on. Allocates.
  void take_in(VolterraTerms terms, const RegressionHistory& history, RowWorkspace& work);
  /// Those taken in; null before.
  [[nodiscard]] const VolterraTerms* terms() const { return terms_ ? &*terms_ : nullptr; }
  /// Columns before the inputs' blocks.
  [[nodiscard]] int lead_in() const { return shape_.lead_in() + (terms_ ? terms_->columns() : 0); }
  /// Theirs, of the row whose response is `age` samples old.
  void fill_lead_in(const RegressionHistory& history, int age, double* row) const {
    history.fill_lead_in(cv_, age, row);
    if (terms_) terms_->fill(age, row + shape_.lead_in());
  }
  /// The whole row.
  void fill(const RegressionHistory& history, int age, double* row) const {
    fill_lead_in(history, age, row);
    history.fill_inputs(age, row + lead_in());
  }

  /// After the history took a sample.
  void add_sample(const RegressionHistory& history, RowWorkspace& work);
  /// Before the history skips `missing` samples, folded.
  void add_gap(std::int64_t missing);
  /// After it skipped them.
  void follow_gap(std::int64_t missing, const RegressionHistory& history);
  /// Takes the rows that wait; before, nothing else that is asked here knows of them.
  void fold(const RegressionHistory& history, RowWorkspace& work);
  /// Forgets what is older than the last `samples` samples (>= 0). Rows are weighed anew: what was
  /// surprising under what is now forgotten may be usual after it.
  void start_afresh(int samples, const RegressionHistory& history, RowWorkspace& work);

  /// Without the terms that were taken in; a fresh start is to follow. Allocates.
  void leave_out_terms();

  /// How often it has begun afresh.
  [[nodiscard]] std::uint64_t restarts() const { return restarts_; }

  [[nodiscard]] const RegressionMemory& memory(int index) const {
    return memories_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const NoiseLevel& noise() const { return noise_; }
  /// Samples that the memories may rest on, at most `remembered`.
  [[nodiscard]] int span() const { return span_; }
  /// Weight that multiplies the row of age `age`, 0 where there is none; 1 / CV units.
  [[nodiscard]] double row_weight(int age) const { return weights_.window()[age]; }
  /// What it counts for (`RowWeight`).
  [[nodiscard]] double row_share(int age) const { return shares_.window()[age]; }
  /// Weight with rows clipped later, each of which counts whole: after a change many rows surprise,
  /// and they are what tells of it.
  [[nodiscard]] double lenient_weight(int age) const {
    constexpr double kLenience =
        calibration::row_weights::kLenientClip / calibration::row_weights::kClip;
    return std::min(kLenience * row_weight(age) / std::sqrt(row_share(age)),
                    1.0 / scales_.window()[age]);
  }

  /// `model`: the one that terms are made of; the history's depth is that of their windows.
  void archive(Archive& a, const LinearModel& model, const RegressionHistory& history,
               const RowWorkspace& work);

 private:
  /// What the fit leaves of one of the first rows: its error, CV units, its leverage taken out, and
  /// that leverage, of the whole row against all others.
  struct FirstRow {
    double error = 0.0;
    double leverage = 0.0;
  };

  void make_room(int columns);
  [[nodiscard]] int patience(const RowWorkspace& work) const;
  void take(int oldest, int newest, const RegressionHistory& history, RowWorkspace& work);
  void gather(int oldest, int newest, const RegressionHistory& history, RowWorkspace& work) const;
  void preview(RowWorkspace& work) const;
  void weigh(int oldest, int newest, const RowWorkspace& work);
  void weigh_row(int age, const RowWeight& weight);
  void weigh_copy(std::size_t k, double weight, RowWorkspace& work) const;
  void copy_weighed(int age, const RegressionHistory& history, RowWorkspace& work) const;
  [[nodiscard]] static bool full(const RowWorkspace& work);
  void take_weighed(RegressionMemory& memory, RowWorkspace& work) const;
  [[nodiscard]] int first_rows() const {
    return calibration::row_weights::kFirstRowsPerColumn * columns_ + cv_;
  }
  void begin_noise();
  void reserve_first_rows();
  void settle(int newest, const RegressionHistory& history, RowWorkspace& work);
  [[nodiscard]] double spread(int newest, const RegressionHistory& history, RowWorkspace& work);
  [[nodiscard]] FirstRow first_row(int age, const GivensQr::Preview& left) const;
  [[nodiscard]] double clipped_share(double scale) const;
  void slide(std::size_t index, const RegressionHistory& history, RowWorkspace& work);
  void refill(RegressionMemory& memory, int samples, const RegressionHistory& history,
              RowWorkspace& work) const;

  int cv_;
  RegressionShape shape_;
  int columns_;
  int remembered_;
  int span_ = 0;
  int waiting_ = 0;  // samples since the last fold
  std::uint64_t restarts_ = 0;
  bool settled_ = false;  // rows since the last start are enough to be weighed
  NoiseLevel noise_;
  LagWindow weights_;  // per sample: 1 / scale, times the clip; 0 = no row, < 0: it waits
  LagWindow shares_;   // per sample, 0..1
  LagWindow scales_;   // per sample: the noise level before it
  std::optional<VolterraTerms> terms_;
  std::vector<RegressionMemory> memories_;
  std::vector<FirstRow> first_;  // since the last start
  std::vector<double> sorted_;   // their errors
  std::vector<int> slides_;      // per memory: samples since its window was rebuilt
};

}  // namespace mpm
