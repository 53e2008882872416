#include "core/identify/diagnosis/selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/validation.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/mean_reversion.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr std::size_t kLoaded = 2;

/// Squared errors of a model with and without an effect in the CVs that it touches, each in units
/// of the former's mean, row by row.
class Errors {
 public:
  Errors(const Effect& effect, const ModelSpec& with, const ModelSpec& without, Unseen& unseen)
      : unseen_(unseen) {
    for (int cv = 0; cv < with.cv_count; ++cv)
      if (touches(effect, with, cv) || touches(effect, without, cv)) add(with, without, cv);
  }
  /// Of one CV.
  Errors(int cv, const ModelSpec& with, const ModelSpec& without, Unseen& unseen)
      : unseen_(unseen) {
    add(with, without, cv);
  }

  [[nodiscard]] CvScore free_run(std::uint64_t seed) const {
    Sum sum(unseen_.rows());
    for (std::size_t j = 0; j < with_.size(); ++j)
      sum.add(without_[j].cwiseAbs2(), with_[j].cwiseAbs2());
    return sum.score(unseen_, seed);
  }

  [[nodiscard]] CvScore predictions(std::uint64_t seed) const {
    Sum sum(unseen_.rows());
    for (std::size_t j = 0; j < with_.size(); ++j)
      for (const Index horizon : unseen_.horizons())
        sum.add(unseen_.prediction_errors(without_[j], horizon),
                unseen_.prediction_errors(with_[j], horizon));
    return sum.score(unseen_, seed);
  }

  [[nodiscard]] CvScore innovations(std::uint64_t seed) const {
    Sum sum(unseen_.rows());
    for (std::size_t j = 0; j < with_.size(); ++j)
      sum.add(unseen_.innovations(without_throughout_[j]), unseen_.innovations(throughout_[j]));
    return sum.score(unseen_, seed);
  }

  /// CVs of which the free run is better beyond doubt, and which come back to a level.
  [[nodiscard]] std::size_t better_cvs(std::uint64_t seed) const {
    std::size_t count = 0;
    for (std::size_t j = 0; j < with_.size(); ++j)
      if (free_run_of(j, seed).gain_low > 0.0 && comes_back(throughout_[j])) ++count;
    return count;
  }
  /// Whether the free run of some CV is worse beyond doubt.
  [[nodiscard]] bool some_cv_is_worse(std::uint64_t seed) const {
    for (std::size_t j = 0; j < with_.size(); ++j)
      if (free_run_of(j, seed).gain_high < 0.0) return true;
    return false;
  }
  [[nodiscard]] std::size_t cvs() const { return with_.size(); }
  /// Whether what is left of some CV wanders.
  [[nodiscard]] bool wander() const {
    for (std::size_t j = 0; j < throughout_.size(); ++j)
      if (wanders(throughout_[j], slowest_rows_[j])) return true;
    return false;
  }

 private:
  struct Sum {
    explicit Sum(Index rows) : before(VectorXd::Zero(rows)), after(before) {}
    /// Of the last rows; the others count no more.
    void add(const VectorXd& old_errors, const VectorXd& new_errors) {
      const double scale = mean_of_finite(new_errors);
      const Index rows = old_errors.size();
      before.head(before.size() - rows).setConstant(std::numeric_limits<double>::quiet_NaN());
      before.tail(rows) += old_errors / scale;
      after.tail(rows) += new_errors / scale;
    }
    [[nodiscard]] CvScore score(const Unseen& unseen, std::uint64_t seed) const {
      return score_errors(before, after, unseen.block(), seed);
    }
    VectorXd before, after;
  };

  [[nodiscard]] CvScore free_run_of(std::size_t j, std::uint64_t seed) const {
    Sum sum(unseen_.rows());
    sum.add(without_[j].cwiseAbs2(), with_[j].cwiseAbs2());
    return sum.score(unseen_, seed);
  }

  void add(const ModelSpec& with, const ModelSpec& without, int cv) {
    throughout_.push_back(unseen_.residual_throughout(with, cv));
    without_throughout_.push_back(unseen_.residual_throughout(without, cv));
    with_.emplace_back(throughout_.back().tail(unseen_.rows()));
    without_.emplace_back(without_throughout_.back().tail(unseen_.rows()));
    slowest_rows_.push_back(slowest_of_cv_s(without, cv, 1.0) / without.sample_time_s);
  }

  Unseen& unseen_;
  std::vector<VectorXd> with_, without_;
  std::vector<VectorXd> throughout_, without_throughout_;  // on all rows
  std::vector<double> slowest_rows_;
};

/// What is worse in the judgement of predictions or free runs. Under feedback those of the plant's
/// own model may be: its inputs undo what disturbs it, which a model that is wrong takes for an
/// answer; and what wanders makes a free run worse by chance. One-step errors are not taken in so,
/// and have the last word.
Fate worse(const Errors& errors, std::uint64_t seed) {
  return errors.innovations(seed).gain_high > 0.0 ? Fate::kNoBetter : Fate::kRefused;
}

/// Whether a model is better at predictions, by so much that it is worth an accusation.
Fate judged_by_predictions(const CvScore& predictions, const Errors& errors, std::uint64_t seed) {
  if (!(predictions.gain_high > 0.0)) return worse(errors, seed);
  const bool worth = predictions.rmse_after < (1.0 - kLeastRepair) * predictions.rmse_before;
  return worth && predictions.gain_low > 0.0 ? Fate::kRepaired : Fate::kNoBetter;
}

Fate judged(const Effect& effect, const ModelSpec& model, const Errors& errors,
            const Judges& judges, std::uint64_t seed, bool wanders, double& sure_gain) {
  const CvScore free_run = errors.free_run(seed);
  sure_gain = free_run.gain_low;
  if (!cause_of(effect).acts_through_channels()) {
    // What loads several CVs through one actuator shows in more than one of them, and against none.
    const bool doubtful =
        effect.place.cv < 0 && (errors.better_cvs(seed) < std::min(kLoaded, errors.cvs()) ||
                                errors.some_cv_is_worse(seed));
    if (free_run.gain_low > 0.0) return doubtful ? Fate::kNoBetter : Fate::kRepaired;
    return free_run.rmse_after < free_run.rmse_before ? Fate::kNoBetter : Fate::kRefused;
  }
  const CvScore predictions = errors.predictions(seed);
  sure_gain = predictions.gain_low;
  // A stuck actuator opens the loop. What wanders makes a free run better or worse by chance.
  const bool open_loop = effect.edit == &causes::input_stuck() ||
                         moved_from_outside(effect, model, judges.outside_shares);
  if (open_loop && !wanders && !(free_run.gain_high > 0.0)) return worse(errors, seed);
  const Fate fate = judged_by_predictions(predictions, errors, seed);
  const bool in_doubt =
      fate == Fate::kRepaired && open_loop && !(free_run.rmse_after < free_run.rmse_before);
  return in_doubt && !(errors.innovations(seed).gain_low > 0.0) ? Fate::kNoBetter : fate;
}

/// Each may be better beside the others, some of which have gone since, and what is left of them
/// worse than none: in every CV those of one kind are judged once more together, and the weakest
/// that does not carry over in all CVs that it acts on gets `fate(errors)` until they are better
/// than none. `is_one(effect, cv)`: of that kind, in that CV; `score(errors)`: what they are judged
/// by.
template <class IsOne, class Score, class FateOf>
void judge_together(const Problem& problem, const SearchResult& found, const Judges& judges,
                    const IsOne& is_one, const Score& score, const FateOf& fate,
                    Selection& selection) {
  const int cvs = problem.model().cv_count;
  const std::vector<bool> keep(static_cast<std::size_t>(cvs), true);
  const auto model_of = [&](const std::vector<bool>& in) {
    return extend(problem, found, in, keep, judges.open);
  };
  const auto carries_over = [&](std::size_t i, const std::vector<bool>& in) {
    const Effect& effect = found.named[i].effect;
    if (effect.place.cv >= 0) return false;
    std::vector<bool> others = in;
    others[i] = false;
    return score(Errors(effect, model_of(in), model_of(others), judges.unseen)).gain_low > 0.0;
  };
  for (int cv = 0; cv < cvs; ++cv) {
    for (;;) {
      const std::vector<bool> in = repaired(selection);
      std::vector<bool> without = in;
      std::vector<std::size_t> own;  // the weakest first
      for (const std::size_t i : selection.order) {
        const Effect& effect = found.named[i].effect;
        if (!in[i] || effect.certain || !is_one(effect, cv)) continue;
        without[i] = false;
        own.push_back(i);
      }
      if (own.empty()) break;
      const Errors errors(cv, model_of(in), model_of(without), judges.unseen);
      const CvScore gain = score(errors);
      if (gain.rmse_after <= gain.rmse_before) break;
      const auto weakest =
          std::find_if(own.begin(), own.end(), [&](std::size_t i) { return !carries_over(i, in); });
      if (weakest == own.end()) break;
      selection.fates[*weakest] = fate(errors);
    }
  }
}

/// The channels' repairs by predictions, disturbances by the free run.
void judge_together(const Problem& problem, const SearchResult& found, const Judges& judges,
                    Selection& selection) {
  const std::uint64_t seed = judges.unseen.seed();
  judge_together(
      problem, found, judges,
      [&](const Effect& effect, int cv) {
        return cause_of(effect).acts_through_channels() && touches(effect, problem.model(), cv);
      },
      [&](const Errors& errors) { return errors.predictions(seed); },
      [&](const Errors& errors) { return worse(errors, seed); }, selection);
  judge_together(
      problem, found, judges,
      [](const Effect& effect, int cv) {
        return !cause_of(effect).acts_through_channels() && effect.place.cv == cv;
      },
      [&](const Errors& errors) { return errors.free_run(seed); },
      [](const Errors&) { return Fate::kNoBetter; }, selection);
}

/// Of what is repaired, the other repair without which `i` would be none; null where there is none.
std::optional<std::size_t> needed_by(std::size_t i, const Problem& problem,
                                     const SearchResult& found, const Judges& judges,
                                     const Selection& selection) {
  const std::vector<bool> keep(static_cast<std::size_t>(problem.model().cv_count), true);
  const Effect& effect = found.named[i].effect;
  std::optional<std::size_t> needed;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < found.named.size(); ++j) {
    if (j == i || selection.fates[j] != Fate::kRepaired || found.named[j].effect.certain) continue;
    std::vector<bool> in = repaired(selection);
    in[j] = false;
    const ModelSpec with = extend(problem, found, in, keep, judges.open);
    in[i] = false;
    const Errors errors(effect, with, extend(problem, found, in, keep, judges.open), judges.unseen);
    double sure_gain = 0.0;
    if (judged(effect, problem.model(), errors, judges, judges.unseen.seed() + i,
               selection.wanders[i], sure_gain) == Fate::kRepaired ||
        sure_gain >= least)
      continue;
    needed = j;
    least = sure_gain;
  }
  return needed;
}

}  // namespace

bool moved_from_outside(const Effect& effect, const ModelSpec& model,
                        const std::vector<std::optional<double>>& shares) {
  const auto from_outside = [&](int input) {
    const auto i = static_cast<std::size_t>(input);
    return i >= shares.size() || shares[i].value_or(1.0) >= kMostlyOutside;
  };
  if (effect.place.input >= 0) return from_outside(effect.place.input);
  return std::all_of(model.channels.begin(), model.channels.end(), [&](const ChannelSpec& channel) {
    return channel.cv != effect.place.cv || from_outside(channel.input);
  });
}

Selection select(const Problem& problem, const SearchResult& found, const Judges& judges,
                 const std::function<void()>& tell) {
  const std::vector<bool> keep(static_cast<std::size_t>(problem.model().cv_count), true);
  Selection selection;
  selection.explains.assign(found.named.size(), 0.0);
  selection.sure_gains = selection.explains;
  selection.wanders.assign(found.named.size(), false);
  selection.with.assign(found.named.size(), std::nullopt);
  selection.order.resize(found.named.size());
  std::iota(selection.order.begin(), selection.order.end(), std::size_t{0});
  std::sort(selection.order.begin(), selection.order.end(), [&](std::size_t a, std::size_t b) {
    return found.named[a].evidence < found.named[b].evidence;
  });
  for (const Named& named : found.named)
    selection.fates.push_back(causes::is_unnamed(cause_of(named.effect)) ? Fate::kNoBetter
                                                                         : Fate::kRepaired);
  const auto model_of = [&](std::vector<bool> in, std::size_t i, bool taken,
                            bool all_open = false) {
    in[i] = taken;
    return extend(problem, found, in, keep, all_open ? OpenChannels{} : judges.open);
  };
  for (const std::size_t i : selection.order) {
    tell();
    const Effect& effect = found.named[i].effect;
    if (effect.certain || selection.fates[i] != Fate::kRepaired) continue;
    const std::vector<bool> in = repaired(selection);
    const Errors errors(effect, model_of(in, i, true), model_of(in, i, false), judges.unseen);
    selection.wanders[i] = errors.wander();
    if (causes::passes(effect) && has_passed(effect, problem, judges.unseen)) {
      selection.fates[i] = Fate::kOver;
      continue;
    }
    selection.fates[i] = judged(effect, problem.model(), errors, judges, judges.unseen.seed() + i,
                                selection.wanders[i], selection.sure_gains[i]);
    if (selection.fates[i] == Fate::kNoBetter && cause_of(effect).borne_out(effect, problem)) {
      const CvScore score = errors.free_run(judges.unseen.seed() + i);
      if (score.rmse_after < score.rmse_before) selection.fates[i] = Fate::kRepaired;
    }
    // A slow disturbance was fitted together with small errors of the channels, which the extended
    // model does without: it may be true and still be no repair by itself.
    if (selection.fates[i] != Fate::kRefused || cause_of(effect).acts_through_channels()) continue;
    const Errors with_small_errors(effect, model_of(in, i, true, true),
                                   model_of(in, i, false, true), judges.unseen);
    if (with_small_errors.free_run(judges.unseen.seed() + i).gain_low > 0.0)
      selection.fates[i] = Fate::kNoBetter;
  }
  // Set-points are no inputs of a model, whatever goes with them.
  for (std::size_t i = 0; i < found.named.size(); ++i)
    if (found.named[i].effect.place.aux >= judges.aux)
      selection.fates[i] = selection.fates[i] == Fate::kRepaired ? Fate::kNoBetter : Fate::kRefused;
  judge_together(problem, found, judges, selection);
  // Beside all that stayed.
  const std::vector<bool> in = repaired(selection);
  for (const std::size_t i : selection.order) {
    tell();
    if (selection.fates[i] == Fate::kOver) continue;
    const Effect& effect = found.named[i].effect;
    const CvScore score =
        Errors(effect, model_of(in, i, true), model_of(in, i, false), judges.unseen)
            .free_run(judges.unseen.seed());
    if (score.rmse_before > 0.0) {
      const double left = score.rmse_after / score.rmse_before;
      selection.explains[i] = 1.0 - left * left;
    }
    if (selection.fates[i] == Fate::kRepaired && !effect.certain)
      selection.with[i] = needed_by(i, problem, found, judges, selection);
  }
  return selection;
}

bool has_passed(const Effect& effect, const Problem& problem, Unseen& unseen) {
  ModelSpec disturbed = problem.model();
  apply(effect, problem.surroundings(), disturbed);
  const int cv = effect.place.cv;
  const VectorXd added =
      unseen.residual_throughout(problem.model(), cv) - unseen.residual_throughout(disturbed, cv);
  const auto energy = [](const auto& rows) {
    return rows.unaryExpr([](double x) { return std::isfinite(x) ? x * x : 0.0; }).sum();
  };
  return energy(added.tail(unseen.rows())) <= kPassed * energy(added);
}

std::vector<bool> repaired(const Selection& selection) {
  std::vector<bool> in;
  for (const Fate fate : selection.fates) in.push_back(fate == Fate::kRepaired);
  return in;
}

}  // namespace mpm
