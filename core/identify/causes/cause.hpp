#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/causes/signal_names.hpp"
#include "core/identify/fit/effect.hpp"
#include "core/identify/fit/problem.hpp"
#include "core/parallel/parallel.hpp"

namespace mpm {

/// What causes are proposed from: the data, and what is left of them by all that was accepted.
struct Outlook {
  Problem& problem;
  const std::vector<Effect>& accepted;
  const std::vector<CvFit>& without;  ///< of each CV, with `accepted` alone
  const Parallel& parallel = one_thread();

  [[nodiscard]] const ModelSpec& model() const { return problem.model(); }
  [[nodiscard]] const Recording& recording() const { return problem.recording(); }
  [[nodiscard]] double sample_time_s() const { return problem.surroundings().sample_time_s; }
  /// MVs and DVs; aux signals are numbered after them.
  [[nodiscard]] int inputs() const { return problem.surroundings().model_inputs; }
  /// The CVs that the model has this input act on, ascending.
  [[nodiscard]] std::vector<int> cvs_of(int input) const;
};

/// How the numbers of an effect are stepped about where its misfit is not smooth in them.
struct Stepping {
  std::vector<double> reaches = {};  ///< ever closer; none = the misfit is smooth
  int neighbours = 0;                ///< at each reach
  bool from_the_first = false;       ///< after an improvement begin again with the first neighbour
};

/// Accepted effects that may be said otherwise: the ones to take out and what to put in instead.
struct Rewrite {
  std::vector<std::size_t> without;  ///< indices, ascending
  std::vector<Effect> with;
};

/// A cause of a difference between plant and model, all of it in one file: what may be proposed,
/// from which start values and under which prior, how it edits the model, how it is refined, when
/// it matters, and the words and numbers that say it. One object each, in catalog.hpp.
class Cause : public Edit {
 public:
  explicit Cause(const CauseName& name, const char* kind = "") : name_(name), kind_(kind) {}

  [[nodiscard]] const CauseName& name() const { return name_; }
  /// Which of its name: of a nonlinearity, shape of a disturbance, term of a state; else empty.
  [[nodiscard]] const char* kind() const { return kind_; }

  // Proposing.

  /// Adds what might be wrong in this way, each with start values; one effect appears several times
  /// where it has to be looked for from several starts. `search_cost` holds 2 ln of the number of
  /// its likes, and of the moments it may have begun at.
  virtual void propose(const Outlook& outlook, std::vector<Effect>& found) const;
  /// What the data themselves show, whatever the model: certain effects.
  [[nodiscard]] virtual std::vector<Effect> shown_by(const Problem& problem) const;
  /// Whether such an effect may still be looked for beside one that was accepted.
  [[nodiscard]] virtual bool goes_with(const Effect& accepted, const Effect& mine) const;
  /// A static block before an input's channels, of which there is one.
  [[nodiscard]] virtual bool is_input_block() const { return false; }
  /// Whether this accepted effect has found the linear part of its channel along with itself.
  [[nodiscard]] virtual bool settles_channel(const Effect& mine) const;

  /// Whether it shows as errors of the channels at its place, so that a test of those must see it:
  /// everything but what disturbs a CV by itself.
  [[nodiscard]] virtual bool acts_through_channels() const { return true; }

  /// Whether it bends what is straight, as feedback makes a straight line look.
  [[nodiscard]] virtual bool is_curve() const { return false; }

  // Weighing.

  /// 2 ln of the prior odds against it: errors of channels are what one expects.
  [[nodiscard]] virtual double rarity() const;
  /// Odds, against it, of what acts alike and is no cause here: no recording tells the two apart,
  /// so that it takes its share of the confidence.
  [[nodiscard]] virtual double alike() const { return 0.0; }
  /// Slow and without an edge, so that a noise model can take it for its own.
  [[nodiscard]] virtual bool may_pass_for_noise() const { return false; }
  /// Whether anyone would care; nothing: judged by how much of the CV it moves.
  [[nodiscard]] virtual std::optional<bool> matters(const Effect& mine,
                                                    const Tolerances& materiality) const;
  /// What names this and other errors of the same channel together; null: nothing does.
  [[nodiscard]] virtual const Cause* together_with_others() const { return nullptr; }

  /// Whether the measurements speak against it, however well it fits.
  [[nodiscard]] virtual bool contradicted(const Effect& mine, const Problem& problem) const;
  /// Whether they show it, so that no more is asked of it than to make nothing worse.
  [[nodiscard]] virtual bool borne_out(const Effect& mine, const Problem& problem) const;

  // Refining what a Gauss-Newton step cannot, since the misfit has kinks there.

  /// Once it is the best explanation: all that is worth a look near it, given what was tried.
  [[nodiscard]] virtual std::vector<Effect> closer_look(const Effect& mine,
                                                        const std::vector<Effect>& tried) const;
  [[nodiscard]] virtual Stepping stepping(const Effect& mine) const;
  /// One of the neighbours at this reach; only where there is a stepping.
  [[nodiscard]] virtual Effect neighbour(const Effect& mine, double reach, int index,
                                         const Problem& problem) const;
  /// So many of its first numbers get their intervals from the real rise of the misfit.
  [[nodiscard]] virtual int kinked_numbers() const { return 0; }
  /// Another way to say what the accepted effects around `mine` say, with fewer parts wrong.
  [[nodiscard]] virtual std::vector<Rewrite> rewrites(std::size_t mine,
                                                      const std::vector<Effect>& accepted,
                                                      const Problem& problem,
                                                      const Tolerances& materiality) const;

  // Saying.

  /// What the innovations of the last fit show that no edit of a model repairs; `refused` says why
  /// one is in doubt.
  [[nodiscard]] virtual std::vector<Finding> left_in(const Problem& problem, const Fit& fit) const;

  /// Turns the plainly stated numbers of a finding into what the contract asks for.
  virtual void restate(const Effect& mine, const Problem& problem, Finding& finding) const;
  /// What a finding means, in whole sentences, each with a space behind it.
  [[nodiscard]] virtual std::string sentence(const Finding& finding,
                                             const SignalNames& names) const = 0;
  /// Whether the interval of what it does includes that it does nothing: then it is no finding.
  /// The first number unless it says otherwise.
  [[nodiscard]] virtual bool may_be_nothing(const Finding& finding) const;
  /// Whether reports give the onset among the parameters too.
  [[nodiscard]] virtual bool has_onset_parameter() const { return false; }
  /// Whether what acts is named as a signal even where it is an input of the model.
  [[nodiscard]] virtual bool names_its_source() const { return false; }

 protected:
  /// An effect of this cause.
  [[nodiscard]] Effect effect(const Place& place, std::vector<Coordinate> coordinates,
                              double search_cost, Eigen::Index onset = 0) const;

 private:
  const CauseName& name_;
  const char* kind_;
};

/// The cause whose effect this is: whatever edits a model here is one.
[[nodiscard]] const Cause& cause_of(const Effect& effect);
[[nodiscard]] Subject subject_of(const Effect& effect);

/// 2 ln of so many equal alternatives; 0 counts as 1.
[[nodiscard]] double cost_of(std::size_t alternatives);

}  // namespace mpm
