#include "core/identify/diagnosis/account.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/nameable.hpp"
#include "core/identify/diagnosis/noise_choice.hpp"
#include "core/identify/diagnosis/setpoint_rival.hpp"
#include "core/identify/diagnosis/statement.hpp"
#include "core/identify/diagnosis/undecided.hpp"
#include "core/identify/search/conclude.hpp"
#include "core/identify/search/walk_odds.hpp"

namespace mpm {
namespace {

constexpr const char* kWanders =
    "what is left of the CV wanders, and its steps from sample to sample do not bear it out";

/// Whether an answer to a signal may be no more than a CV that wanders beside one that does.
bool may_be_a_walk(Problem& problem, const SearchResult& found, std::size_t answer,
                   const SearchSettings& settings) {
  const Effect& effect = found.named[answer].effect;
  if (effect.certain || !cause_of(effect).acts_through_channels()) return false;
  return most_odds(problem, found.fit, answer) < settings.decisive;
}

/// Whether a CV that is controlled would hardly answer an input any more. It looks so whatever its
/// gain is where the controller undoes a disturbance that is slower than the noise is believed to
/// be: inputs move, and the CV stays where it was.
bool silences(const Effect& effect, const Finding& finding, const Problem& problem,
              const Judges& judges) {
  const Parameter* gain = finding.find(kGainRatio);
  if (gain == nullptr || !(std::abs(gain->value) < kHardlyAnswers)) return false;
  const auto channels = channels_of(effect, problem.model(), problem.surroundings().model_inputs);
  const Eigen::MatrixXd& setpoints = problem.recording().setpoints;
  return std::any_of(channels.begin(), channels.end(), [&](const std::pair<int, int>& channel) {
    const int cv = channel.first;
    const auto input = static_cast<std::size_t>(channel.second);
    return cv < setpoints.cols() && setpoints.col(cv).array().isFinite().any() &&
           input < judges.outside_shares.size() &&
           judges.outside_shares[input].value_or(1.0) < kNoFeedback;
  });
}

/// Why a finding goes, for a person; null where it stays. `all`: what was found.
const char* why_it_goes(const Named& named, const std::vector<Named>& all, const Problem& problem,
                        const Finding& finding, Fate fate, const Judges& judges) {
  const Effect& effect = named.effect;
  const Cause& cause = cause_of(effect);
  if (effect.certain || causes::is_unnamed(cause)) return nullptr;
  if (fate == Fate::kRefused) return why_not_in_model(fate);
  if (fate == Fate::kOver && named.evidence < kStrongEvidence) return kNotBorneOut;
  if (fate == Fate::kNoBetter && accuses(subject_of(effect)) && !cause.acts_through_channels())
    return why_not_in_model(fate);
  if (cause.contradicted(effect, problem)) return "the measurements themselves speak against it";
  if (cause.may_be_nothing(finding)) return "its interval includes that it does nothing";
  if (is_guess(finding)) return "other causes are as probable: the data do not decide between them";
  if (const char* why = why_not_step(effect, all, problem.model(), problem.recording())) return why;
  if (silences(effect, finding, problem, judges))
    return "a CV that its controller holds against a disturbance looks as if it hardly answered";
  return judges.compressed.may_have_made(finding) ? kMadeByCompression : nullptr;
}

/// Whether what an accusation explains follows a set-point rather, once everything else that was
/// found is repaired: before, that hides it.
bool follows_setpoint(const Problem& problem, const SearchResult& found, std::vector<bool> others,
                      std::size_t accusation, const Judges& judges, const Witness& witness) {
  others[accusation] = false;
  if (std::find(others.begin(), others.end(), true) == others.end()) return false;
  const std::vector<bool> keep(static_cast<std::size_t>(problem.model().cv_count), true);
  const ChannelTests tests =
      witness.of(stages_of(problem, found, others, keep, judges.open), OwnPast::kLags);
  const std::vector<int> cvs = touched(found.named[accusation].effect, problem);
  return std::any_of(cvs.begin(), cvs.end(), [&](int cv) { return tests.setpoint(cv).wins; });
}

/// Whether a CV's own set-point says what is laid to its channels more simply: undecided between
/// them, one accusation has to leave the test nothing to see.
bool own_setpoint_is_simpler(const SearchResult& found, std::size_t accusation, Confirmation says,
                             const ChannelTests& given) {
  const int cv = found.named[accusation].effect.place.cv;
  if (cv < 0 || !own_setpoint_undecided(given, cv)) return false;
  const auto accusations =
      std::count_if(found.named.begin(), found.named.end(), [cv](const Named& named) {
        return accuses(subject_of(named.effect)) && named.effect.place.cv == cv;
      });
  return says < Confirmation::kNothing || accusations > 1;
}

/// Whether what is said of a gain contradicts, beyond doubt, what the monitor's test measures of it
/// while it sees nothing wrong: that test holds under feedback, which a free run does not.
bool measured_otherwise(const Effect& effect, const Problem& problem, const Finding& finding,
                        const ChannelTests& by_monitor) {
  const Parameter* gain = finding.find(kGainRatio);
  const auto channels = channels_of(effect, problem.model(), problem.surroundings().model_inputs);
  if (gain == nullptr || effect.onset > 0 || by_monitor.reject(channels, kSeesNothing))
    return false;
  return std::any_of(channels.begin(), channels.end(), [&](const std::pair<int, int>& channel) {
    const Estimate measured = by_monitor.gain_error(channel.first, channel.second);
    return std::abs(gain->value - 1.0 - measured.value) > kBeyondDoubtSd * measured.deviation;
  });
}

/// Whether nothing but its own valve moves a loop: no repair follows that swing for long.
bool swings_by_itself(const Effect& effect, const Judges& judges) {
  const auto input = static_cast<std::size_t>(effect.place.input);
  return input < judges.outside_shares.size() &&
         judges.outside_shares[input].value_or(1.0) < kHardlyOutside;
}

/// What the calibrated test does not bear out goes, unless it overwhelms; where feedback moves the
/// input, what leaves the test anything to see goes; anywhere, what leaves it something and makes
/// the free run worse: of a CV that wanders, or whose structure is missing, better predictions
/// alone prove too little. So does an accusation that makes predictions no better beyond doubt,
/// unless the test was sure of a channel's error on all rows and sees all of it gone: the unseen
/// ones may hold too little movement to tell. (Not where it began later: what may begin anywhere
/// leaves the test less to see by itself.) And no gain stays that the monitor's test has measured
/// otherwise. Why, for a person; null where it stays. `findings`: of
/// what was found, in order.
std::vector<const char*> unconfirmed(const Problem& problem, const SearchResult& found,
                                     const std::vector<Finding>& findings,
                                     const Selection& selection, const Judges& judges,
                                     const Witness& witness) {
  std::vector<const char*> reasons(found.named.size(), nullptr);
  std::vector<bool> tested(found.named.size(), false);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    const Effect& effect = found.named[i].effect;
    tested[i] = selection.fates[i] == Fate::kRepaired ||
                (accuses(subject_of(effect)) && !causes::is_unnamed(cause_of(effect)));
  }
  const auto concerned = [&](std::size_t i) {
    const Effect& effect = found.named[i].effect;
    return tested[i] && !effect.certain && cause_of(effect).acts_through_channels() &&
           !cause_of(effect).borne_out(effect, problem);
  };
  bool any = false;
  for (std::size_t i = 0; i < tested.size(); ++i) any = any || concerned(i);
  if (!any) return reasons;
  const std::vector<bool> keep(static_cast<std::size_t>(problem.model().cv_count), true);
  const std::vector<Stage> repaired = stages_of(problem, found, tested, keep, judges.open);
  const ChannelTests after = witness.of(repaired, OwnPast::kLags);
  std::optional<ChannelTests> after_nonlinear;
  // Of a curve that the nonlinear test called for its word counts.
  const auto straightened = [&](const Effect& effect) {
    const auto channels = channels_of(effect, problem.model(), problem.surroundings().model_inputs);
    if (!cause_of(effect).is_curve() || !witness.given_nonlinear.bends(channels)) return false;
    if (!after_nonlinear) after_nonlinear = witness.of(repaired, OwnPast::kAsMonitor);
    return !after_nonlinear->bends(channels);
  };
  for (std::size_t i = 0; i < tested.size(); ++i) {
    if (!concerned(i)) continue;
    const Effect& effect = found.named[i].effect;
    const Confirmation linear = confirmation(
        effect, problem.model(), problem.surroundings().model_inputs, witness.given, after);
    const Confirmation says =
        linear < Confirmation::kNothing && straightened(effect) ? Confirmation::kNothing : linear;
    const bool overwhelming =
        selection.sure_gains[i] >= kOverwhelmingGain && effect.edit != &causes::input_stuck();
    const bool outside = moved_from_outside(effect, problem.model(), judges.outside_shares);
    const bool sticks = effect.edit == &causes::stiction();
    if (says == Confirmation::kNone && !(overwhelming && (outside || sticks)) &&
        !(sticks && swings_by_itself(effect, judges)))
      reasons[i] = "with it the test of the channels sees no less wrong";
    else if (accuses(subject_of(effect)) &&
             measured_otherwise(effect, problem, findings[i], witness.given_nonlinear))
      reasons[i] = "the test of the channels measures another gain, and sees nothing wrong";
    else if (says == Confirmation::kLess && !outside)
      reasons[i] = "feedback moves its input, and the test of the channels still sees much wrong";
    else if (accuses(subject_of(effect)) && says < Confirmation::kNothing &&
             selection.explains[i] < 0.0)
      reasons[i] =
          "with it the free run of unseen samples is worse, and the test of the channels "
          "still sees something wrong";
    else if (accuses(subject_of(effect)) && own_setpoint_is_simpler(found, i, says, witness.given))
      reasons[i] = kOwnSetpoint;
    else if (accuses(subject_of(effect)) &&
             follows_setpoint(problem, found, tested, i, judges, witness))
      reasons[i] =
          "without it the CV follows a set-point, and better than any error of its channels";
    else if (selection.fates[i] == Fate::kNoBetter &&
             !((says == Confirmation::kTrace || says == Confirmation::kNothingOfAll) &&
               effect.onset == 0 && is_channel_error(findings[i])))
      reasons[i] = why_not_in_model(Fate::kNoBetter);
  }
  return reasons;
}

Account keep(Explained explained, const Judges& judges, const Witness& witness,
             const SearchSettings& settings) {
  const auto judge = [&](const Problem& problem, const SearchResult& of) {
    return select(problem, of, judges, [&] { settings.progress(kSearched); });
  };
  Account kept{std::move(explained.problem), std::move(explained.found), {}, {}, {}};
  Problem& problem = *kept.problem;
  kept.selection = judge(problem, kept.found);
  for (;;) {
    const SearchResult before = kept.found;
    std::vector<Finding> findings;
    std::vector<bool> out;
    for (std::size_t i = 0; i < before.named.size(); ++i) {
      Finding& finding = findings.emplace_back(to_finding(before, i, problem));
      const char* reason = may_be_a_walk(problem, before, i, settings)
                               ? kWanders
                               : why_it_goes(before.named[i], before.named, problem, finding,
                                             kept.selection.fates[i], judges);
      out.push_back(reason != nullptr);
      finding.repaired = false;
      finding.refused =
          reason != nullptr ? reason : "it explained something only beside what was refused";
      finding.explains = kept.selection.explains[i];
    }
    if (std::find(out.begin(), out.end(), true) == out.end()) {
      const std::vector<const char*> reasons =
          unconfirmed(problem, before, findings, kept.selection, judges, witness);
      for (std::size_t i = 0; i < out.size(); ++i) {
        if (reasons[i] == nullptr) continue;
        out[i] = true;
        findings[i].refused = reasons[i];
      }
    }
    if (std::find(out.begin(), out.end(), true) == out.end()) return kept;
    kept.found = without(problem, before, out, settings);
    const auto stays = [&](const Effect& effect) {
      return causes::is_unnamed(cause_of(effect)) || causes::is_constant_offset(effect) ||
             std::any_of(kept.found.named.begin(), kept.found.named.end(), [&](const Named& named) {
               return subject_of(named.effect) == subject_of(effect) &&
                      named.effect.onset == effect.onset;
             });
    };
    for (const std::size_t i : kept.selection.order) {
      const Effect& effect = before.named[i].effect;
      if (!out[i] && stays(effect)) continue;
      kept.refused.push_back(std::move(findings[i]));
      kept.refused_effects.push_back(effect);
    }
    kept.selection = judge(problem, kept.found);
  }
}

bool overwhelms(const Account& account, const SearchSettings& tested) {
  bool any = false;
  for (std::size_t i = 0; i < account.found.named.size(); ++i) {
    const Effect& effect = account.found.named[i].effect;
    if (effect.certain || tested.may_name(effect)) continue;
    any = true;
    if (account.selection.fates[i] != Fate::kRepaired ||
        account.selection.sure_gains[i] < kOverwhelmingGain)
      return false;
  }
  return any;
}

/// Names the levels that only the other account can tell, where unseen samples bear them out here
/// and what is said of the rest stays as it is.
void take_levels(const Account& other, const Judges& judges, const SearchSettings& settings,
                 Account& account) {
  std::vector<Effect> known;
  for (std::size_t i = 0; i < other.found.named.size(); ++i)
    if (causes::is_constant_offset(other.found.named[i].effect) &&
        other.selection.fates[i] == Fate::kRepaired)
      known.push_back(other.found.named[i].effect);
  SearchResult found = account.found;
  name_known_levels(*account.problem, known, found);
  if (found.named.size() == account.found.named.size()) return;
  Selection selection =
      select(*account.problem, found, judges, [&] { settings.progress(kSearched); });
  std::vector<Fate> wanted = account.selection.fates;
  wanted.resize(found.named.size(), Fate::kRepaired);
  if (selection.fates != wanted) return;
  account.found = std::move(found);
  account.selection = std::move(selection);
}

}  // namespace

const char* why_not_in_model(Fate fate) {
  switch (fate) {
    case Fate::kNoBetter:
      return "with it unseen samples are explained no better, beyond doubt and by enough to matter";
    case Fate::kOver:
      return "it had passed before the samples on which repairs are measured";
    case Fate::kRefused:
      return "with it unseen samples are explained worse";
    case Fate::kRepaired:
      break;
  }
  return "";
}

Account account_for(const ModelSpec& model, int model_inputs, const Recording& fitted,
                    const Judges& judges, const Witness& witness, const SearchSettings& settings) {
  const auto take = [&](const SearchSettings& with) {
    return keep(explain(model, model_inputs, fitted, with), judges, witness, with);
  };
  Account account = take(settings);
  const std::optional<Named>& suspect = account.found.suspect;
  const auto shown_by_free_run = [&](const Effect& effect) {
    return moved_from_outside(effect, model, judges.outside_shares) &&
           !witness.given.undone(channels_of(effect, model, model_inputs));
  };
  if (!suspect || suspect->evidence < kStrongEvidence || !shown_by_free_run(suspect->effect))
    return account;
  SearchSettings open = settings;
  open.may_name = [&](const Effect& effect) {
    return settings.may_name(effect) ||
           (cause_of(effect).acts_through_channels() && shown_by_free_run(effect));
  };
  Account other = take(open);
  if (overwhelms(other, settings)) return other;
  take_levels(other, judges, settings, account);
  return account;
}

}  // namespace mpm
