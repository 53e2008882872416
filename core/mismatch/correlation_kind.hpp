#pragma once

namespace mpm {

/// What the correlation of u_i(t) with e_j(t+d) is controlled for (Carlsson 2010), besides their
/// means; u~_i are all inputs but the i-th.
enum class CorrelationKind {
  kLaggedPartial,  ///< (3.15), (3.17): u~_i(t), u~_i(t-1), ..., u~_i(t-g)
  kPartial,        ///< (3.14): u~_i(t)
  kConventional,   ///< (3.4) at every lag: nothing
  kAlternative,    ///< (3.16): u~_i(t) and u(t-1), ..., u(t-g), its own past too
  kSpearman,       ///< of ranks, nothing (`RankCorrelation`, as the next)
  kRankPartial,    ///< of ranks, those of u~_i(t)
};
[[nodiscard]] constexpr bool of_ranks(CorrelationKind kind) {
  return kind == CorrelationKind::kSpearman || kind == CorrelationKind::kRankPartial;
}

}  // namespace mpm
