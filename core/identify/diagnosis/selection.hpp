#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/identify/diagnosis/compressed.hpp"
#include "core/identify/diagnosis/extension.hpp"
#include "core/identify/diagnosis/unseen.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// What unseen data say of something that was named.
enum class Fate {
  kRepaired,  ///< with it the model is better: the extended model holds it
  kOver,      ///< a disturbance that had passed before: named, no repair
  kNoBetter,  ///< not beyond doubt: named, but the extended model does without
  kRefused,   ///< worse: it does not carry over
};

/// Why a disturbance that passes is not named, for a person: nothing judges it.
inline constexpr const char* kNotBorneOut =
    "no sample is left that could bear it out, and its own evidence is not strong";

/// Everything named and taken into a model at first; then, the weakest first, what does not make
/// the model better on unseen samples goes. What acts through channels is judged by predictions
/// over the horizons (95 % interval of the bootstrap above zero), and where its inputs move mostly
/// from outside the loop the free run may not get worse, unless one-step errors get better beyond
/// doubt; and nothing is refused that these do not find worse. What disturbs a CV by itself is
/// judged by the free run, for a prediction that knows the last error does not feel a level.
struct Selection {
  std::vector<Fate> fates;         ///< of each that was named
  std::vector<double> explains;    ///< likewise: Finding::explains
  std::vector<double> sure_gains;  ///< likewise: lower end of the interval of what it was judged by
  std::vector<bool> wanders;       ///< likewise: whether what is left of some CV wanders
  /// Likewise: of those repaired, which other one must be in the model for it to be a repair.
  std::vector<std::optional<std::size_t>> with;
  std::vector<std::size_t> order;  ///< in which they were judged: the weakest evidence first
};

/// What a selection is made by.
struct Judges {
  Unseen& unseen;
  int aux = 0;  ///< aux signals; those after them are set-points, which are no inputs of a model
  /// Which channels may be corrected a little with what was found.
  OpenChannels open;
  const std::vector<std::optional<double>>& outside_shares;  ///< per input
  Compressed compressed = {};
};

/// `tell` is called before each and may throw to end it all. What has no name repairs nothing, what
/// the data show themselves is not judged.
[[nodiscard]] Selection select(const Problem& problem, const SearchResult& found,
                               const Judges& judges, const std::function<void()>& tell);

/// Whether all inputs that an effect acts through move mostly from outside the loop, or nobody
/// knows; of what acts on a CV's output, all inputs of that CV.
[[nodiscard]] bool moved_from_outside(const Effect& effect, const ModelSpec& model,
                                      const std::vector<std::optional<double>>& shares);

/// Whether a disturbance that comes back is all but over in the rows that judge it.
[[nodiscard]] bool has_passed(const Effect& effect, const Problem& problem, Unseen& unseen);

/// Those with the fate kRepaired.
[[nodiscard]] std::vector<bool> repaired(const Selection& selection);

}  // namespace mpm
