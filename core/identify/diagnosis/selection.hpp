#pragma once

#include <functional>
#include <vector>

#include "core/identify/diagnosis/unseen.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// What unseen data say of something that was named.
enum class Fate {
  kRepaired,  ///< with it the free run is better: the extended model holds it
  kNoBetter,  ///< not beyond doubt: named, but the extended model does without
  kRefused,   ///< worse: it does not carry over
};

/// Everything named and taken into a model at first; then, the weakest first, what does not make
/// the free run better on unseen samples (95 % interval of the bootstrap above zero) goes.
struct Selection {
  std::vector<Fate> fates;         ///< of each that was named
  std::vector<std::size_t> order;  ///< in which they were judged: the weakest evidence first
};

/// `tell` is called before each and may throw to end it all. What has no name repairs nothing, what
/// the data show themselves is not judged.
[[nodiscard]] Selection select(const Problem& problem, const SearchResult& found, Unseen& unseen,
                               const std::function<void()>& tell);

/// Those with the fate kRepaired.
[[nodiscard]] std::vector<bool> repaired(const Selection& selection);

}  // namespace mpm
