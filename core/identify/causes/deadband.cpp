#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/input_block.hpp"
#include "core/identify/causes/valve.hpp"

namespace mpm::causes {
namespace {

constexpr Quantity kWidth{"width", Form::kPlain, Unit::kInput};

/// Shares of the input's range to begin a fit from, and the prior's s.d.
constexpr double kDeadbandStarts[] = {0.02, 0.05, 0.1, 0.2};
constexpr double kDeadbandUsualWidth = 0.15;
constexpr double kLeastWidth = 1e-4;
/// Of the width, a step of the finite difference.
constexpr double kDeadbandStep = 0.03;

/// Play: after it turns, an input must move some way before the plant follows.
class PlayOfInput : public InputBlockCause {
 public:
  PlayOfInput() : InputBlockCause(kInputNonlinearity, "deadband") {}

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const BlockPlace& at : curve_places(outlook)) {
      const double range = at.input.range();
      for (const ErrorOnset& begins : block_onsets(outlook))
        for (const double share : kDeadbandStarts)
          found.push_back(effect(at.place,
                                 {{.quantity = &kWidth,
                                   .value = share * range,
                                   .prior_mean = 0.0,
                                   .prior_sd = kDeadbandUsualWidth * range,
                                   .step = kDeadbandStep * share * range,
                                   .low = kLeastWidth * range,
                                   .high = range}},
                                 cost_of(at.members) + begins.cost, begins.row));
    }
  }

  [[nodiscard]] std::vector<Effect> closer_look(const Effect& mine,
                                                const std::vector<Effect>& tried) const override {
    return sticking_near(mine, mine.value(kWidth, 0.0), tried);
  }
  [[nodiscard]] Stepping stepping(const Effect& mine) const override {
    return width_stepping(mine);
  }
  [[nodiscard]] Effect neighbour(const Effect& mine, double reach, int index,
                                 const Problem&) const override {
    return other_width(mine, reach, index);
  }
  [[nodiscard]] int kinked_numbers() const override { return 2; }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    const Parameter* width = finding.find(kWidth);
    return names.source(place).tag + " has play: after it turns, it must move " +
           (width == nullptr ? "some way" : names.in_source(width->value, place)) + " before " +
           target(finding, names) + " follows" +
           (width == nullptr ? "" : " (" + interval_of(*width) + ")") + ". ";
  }

 protected:
  [[nodiscard]] InputBlock block(const Effect& effect, const Surroundings&) const override {
    return Deadband{effect.value(kWidth, 0.0)};
  }
};

}  // namespace

const Cause& deadband() {
  static const PlayOfInput cause;
  return cause;
}

}  // namespace mpm::causes
