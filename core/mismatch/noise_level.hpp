#pragma once

#include "core/mismatch/calibration.hpp"
#include "core/regression/givens_qr.hpp"

namespace mpm {

/// How large a CV's one-step prediction errors usually are, how heavy their tails, and what a row
/// with such an error is worth: min(1, 3 s / |r|) / s, r its error and s their running s.d. What a
/// row's leverage adds to its error is taken out first, or a loop that suddenly gets excitation
/// after a quiet night would look like an outlier.
class NoiseLevel {
 public:
  /// False until there are rows enough for a first estimate; then every row weighs the same.
  [[nodiscard]] bool known() const { return known_; }
  /// Running s.d. of the one-step errors, CV units; 1 while it is not known.
  [[nodiscard]] double scale() const { return scale_; }

  /// The first estimate, from residuals with `freedom` degrees of freedom.
  void begin(double mean_square, double freedom);
  /// Weight of the row of which this is known before it is taken, 1 / CV units; follows the noise
  /// level. `together`: rows after it were previewed with it.
  double weigh(const GivensQr::Preview& preview, bool together);
  /// The same of an error in s.d., of which its leverage is taken out.
  double weigh(double error) { return weigh(error, false); }
  /// Forgets what the last rows were like, from a scale of before on.
  void restart(double scale);

  /// 0 = as normal noise, 1 = so heavy that the same evidence takes several times the rows; of a
  /// CV of which little is known yet: presumed heavy.
  [[nodiscard]] double heavy_tails() const;
  /// Share of rows with clipped errors, as `heavy_tails` judges it.
  [[nodiscard]] double clipped_share() const { return clipped_share_; }
  /// Mean square of the errors over the last 100 rows against that over the last 2000: well above 1
  /// where the noise rose or the channels changed.
  [[nodiscard]] double surprise() const {
    return lasting_square_ > 0.0 ? recent_square_ / lasting_square_ : 1.0;
  }

  template <class Archive>
  void archive(Archive& a) {
    a(known_, scale_, scale_rows_, recent_square_, lasting_square_, square_rows_, clipped_share_);
  }

 private:
  double weigh(double error, bool new_direction);

  bool known_ = false;
  double scale_ = 1.0;
  double scale_rows_ = 0.0;      // that it rests on
  double recent_square_ = 0.0;   // mean square of the clipped errors, CV units
  double lasting_square_ = 0.0;  // likewise
  double square_rows_ = 0.0;     // since the last restart
  double clipped_share_ = calibration::heavy_tails::kFullShare;
};

}  // namespace mpm
