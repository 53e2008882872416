#pragma once

#include "core/mismatch/calibration.hpp"
#include "core/regression/givens_qr.hpp"

namespace mpm {

/// What a row counts for in a regression.
struct RowWeight {
  double weight = 1.0;  ///< multiplies the row, 1 / CV units
  /// Of a row, 0..1: one that says more than all before it counts for part of one, w = sqrt(share).
  double share = 1.0;
};

/// How large a CV's one-step prediction errors usually are, and what a row with such an error is
/// worth: min(1, 3 s / |r|) / s, r its error and s their running s.d. What a row's leverage h adds
/// to its error is taken out first, or a loop that suddenly gets excitation after a quiet night
/// would look like an outlier.
///
/// A row of which h is large, of a step after long quiet say, decides by itself what the regression
/// says of its direction, and so does its own error, which h has made look small. With normal noise
/// that is what evidence is made of; where tails are heavy, t in 0..1, one shock among such rows
/// would blame a channel. There a row counts for min(1, kMostLeverage / (t h)) of one (bounded
/// influence: Krasker and Welsch 1982), which asks nothing of its own response.
class NoiseLevel {
 public:
  /// `bounded`: where tails are heavy no row decides a direction.
  explicit NoiseLevel(bool bounded = true) : bounded_(bounded) {}

  /// False until there are rows enough for a first estimate; then every row weighs the same.
  [[nodiscard]] bool known() const { return known_; }
  /// Running s.d. of the one-step errors, CV units; 1 while it is not known.
  [[nodiscard]] double scale() const { return scale_; }

  /// The first estimate, from residuals with `freedom` degrees of freedom.
  void begin(double mean_square, double freedom);
  /// Of the row of which this is known before it is taken; follows the noise level. `together`:
  /// rows after it were previewed with it.
  RowWeight weigh(const GivensQr::Preview& preview, bool together);
  /// The same of an error in s.d., of which its leverage is taken out.
  RowWeight weigh(double error, double leverage) { return weigh(error, leverage, false); }
  /// Forgets what the last rows were like; from this scale and share of clipped rows on.
  void restart(double scale, double clipped_share);

  /// Whether a row of that leverage, noise variances, tells how heavy the tails are: what a wrong
  /// model does to those that say much looks like it.
  [[nodiscard]] static bool tells_of_tails(double leverage) {
    return leverage <= calibration::row_weights::kMostLeverage;
  }
  /// 0 = as normal noise, 1 = so heavy that no row may decide a direction.
  [[nodiscard]] double heavy_tails() const;
  /// Share of rows with clipped errors.
  [[nodiscard]] double clipped_share() const { return clipped_share_; }

  /// Mean square of the errors over the last 100 rows against that over the last 2000: well above 1
  /// where the noise rose or the channels changed.
  [[nodiscard]] double surprise() const {
    return lasting_square_ > 0.0 ? recent_square_ / lasting_square_ : 1.0;
  }

  template <class Archive>
  void archive(Archive& a) {
    // not archived: bounded_ (construction)
    a(known_, scale_, scale_rows_, recent_square_, lasting_square_, square_rows_, clipped_share_);
  }

 private:
  RowWeight weigh(double error, double leverage, bool new_direction);

  bool bounded_;
  bool known_ = false;
  double scale_ = 1.0;
  double scale_rows_ = 0.0;      // that it rests on
  double recent_square_ = 0.0;   // mean square of the clipped errors, CV units
  double lasting_square_ = 0.0;  // likewise
  double square_rows_ = 0.0;     // since the last restart
  double clipped_share_ = calibration::heavy_tails::kFromShare;
};

}  // namespace mpm
