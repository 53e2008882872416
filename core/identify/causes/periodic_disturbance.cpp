#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/causes/periodogram.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/causes/square_wave_search.hpp"
#include "core/text/number_text.hpp"

namespace mpm::causes {
namespace {

using Eigen::Index;

constexpr Quantity kPeriod{"period", Form::kPlain, Unit::kSeconds};
/// Of a sine, t from the first row on: sine sin(w t) + cosine cos(w t).
constexpr Quantity kSine{"sine", Form::kPlain, Unit::kCv};
constexpr Quantity kCosine{"cosine", Form::kPlain, Unit::kCv};
constexpr Quantity kFrequency{"frequency", Form::kPlain, Unit::kNone};  ///< Hz
/// Of a square wave: clock of the first row to a rising edge.
constexpr Quantity kBegin{"begin", Form::kPlain, Unit::kSeconds};

/// s.d. of the size, and a step of its finite difference, in s.d. of what is left of the CV.
constexpr double kPeriodicDisturbanceUsualSize = 2.0, kPeriodicDisturbanceSizeStep = 0.05;

/// Peaks of the periodogram that are looked at more closely, from every one of these onsets on
/// (shares of the data); what the onsets cost.
constexpr std::size_t kPeaks = 3;
constexpr double kPeriodicDisturbanceOnsets[] = {0.0, 0.15, 0.3, 0.45, 0.6};
constexpr std::size_t kOnsetChoices = 20;
/// Lowest and highest frequency looked at: cycles in the data, samples per cycle, and how many at
/// most.
constexpr int kPeriodicDisturbanceFewestCycles = 3;
constexpr Index kFewestSamples = 5;
constexpr Index kMostFrequencies = 2000;
constexpr double kFrequencyStep = 0.02, kLeastCycles = 0.3;  ///< in 1 / length of the data

/// Rows by which the edges of a square wave are moved about.
const std::vector<double> kReaches = {16.0, 8.0, 4.0, 2.0, 1.0, 0.5};
constexpr double kBeginSd = 0.25;  ///< periods
constexpr double kPeriodSd = 2.0;  ///< of what moves the last edge by one period

/// A CV swings as a sine, or switches to and fro.
class PeriodicDisturbance : public OutputDisturbance {
 public:
  PeriodicDisturbance() : OutputDisturbance("periodic") {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    DisturbanceTerm term;
    term.cv = effect.place.cv;
    term.shape = DisturbanceShape::kPeriodic;
    if (is_square(effect)) {
      term.square = true;
      term.size = effect.value(kSize, 0.0);
      term.period_s = effect.value(kPeriod, 1.0);
      term.onset_s = surroundings.start_s + effect.value(kBegin, 0.0);
    } else {
      const double sine = effect.value(kSine, 0.0), cosine = effect.value(kCosine, 0.0);
      const double frequency = effect.value(kFrequency, 1.0);
      term.size = std::hypot(sine, cosine);
      term.period_s = 1.0 / frequency;
      // sine sin(w t) + cosine cos(w t) = size sin(w (t - onset))
      term.onset_s = surroundings.start_s - std::atan2(cosine, sine) / (2.0 * M_PI * frequency);
    }
    model.disturbances.push_back(term);
  }
  [[nodiscard]] bool may_pass_for_noise() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    std::vector<std::vector<Effect>> of_each(outlook.without.size());
    outlook.parallel.for_each(of_each.size(), [&](std::size_t cv) {
      sines(outlook, outlook.without[cv], of_each[cv]);
      square_waves(outlook, outlook.without[cv], of_each[cv]);
    });
    for (std::vector<Effect>& some : of_each)
      found.insert(found.end(), std::make_move_iterator(some.begin()),
                   std::make_move_iterator(some.end()));
  }

  [[nodiscard]] Stepping stepping(const Effect& mine) const override {
    if (!is_square(mine)) return {};
    return {kReaches, 4, true};
  }

  /// Begun a little earlier or later, or a little longer or shorter in its period, so that its
  /// edges move by up to `reach` rows.
  [[nodiscard]] Effect neighbour(const Effect& mine, double reach, int index,
                                 const Problem& problem) const override {
    const double sample_time_s = problem.surroundings().sample_time_s;
    const double cycles =
        static_cast<double>(problem.samples()) * sample_time_s / mine.value(kPeriod, sample_time_s);
    const double by = (index < 2 ? -reach : reach) * sample_time_s;
    Effect other = mine;
    Coordinate &begin = other.coordinates[1], &period = other.coordinates[2];
    if (index % 2 == 0) {
      begin.value += by;
    } else {  // the period moves the last edges; those in the middle stay where they are
      begin.value -= 0.5 * by;
      period.value += by / cycles;
    }
    return other;
  }

  void restate(const Effect& mine, const Problem&, Finding& finding) const override {
    if (is_square(mine)) {
      finding.parameters.erase(finding.parameters.begin() + 1);  // where in its period it begins
      Parameter& size = finding.parameters[0];
      if (size.value < 0.0) size = {&kSize, -size.value, -size.high, -size.low};
      return;
    }
    const double size = std::hypot(mine.value(kSine, 0.0), mine.value(kCosine, 0.0));
    const double reach =
        size > 0.0 ? finding.parameters[0].high - finding.parameters[0].value : 0.0;
    const Parameter frequency = finding.parameters.back();
    finding.parameters = {
        {&kSize, size, size - reach, size + reach},
        {&kPeriod, 1.0 / frequency.value, 1.0 / frequency.high, 1.0 / frequency.low}};
  }

 protected:
  [[nodiscard]] std::string what_it_does(const Finding& finding,
                                         const SignalNames& names) const override {
    std::string text = "swings" + by_size(finding, names) + " up and down";
    if (const Parameter* period = finding.find(kPeriod))
      text += " every " + number_text(period->value) + " s";
    return text;
  }

 private:
  static bool is_square(const Effect& effect) { return effect.find(kPeriod) != nullptr; }

  static Coordinate sized(const Quantity& quantity, double sd) {
    return {.quantity = &quantity,
            .prior_sd = kPeriodicDisturbanceUsualSize * sd,
            .step = kPeriodicDisturbanceSizeStep * sd,
            .low = -kUnboundedSize,
            .high = kUnboundedSize};
  }

  void sines(const Outlook& outlook, const CvFit& without, std::vector<Effect>& found) const {
    const Index samples = outlook.problem.samples();
    const double sample_time_s = outlook.sample_time_s();
    const double length_s = static_cast<double>(samples) * sample_time_s;
    const double resolution = 1.0 / length_s;
    const auto most = static_cast<int>(std::min(samples / kFewestSamples, kMostFrequencies));
    const double sd = left_sd(without);
    const double cost = cost_of(static_cast<std::size_t>(outlook.model().cv_count)) +
                        cost_of(static_cast<std::size_t>(most));
    // Of the innovations: peaks stand out of white noise.
    for (const int cycles :
         loudest_cycles(without.innovations, kPeriodicDisturbanceFewestCycles, most, kPeaks)) {
      const double frequency = cycles / length_s;
      for (const double share : kPeriodicDisturbanceOnsets) {
        const auto onset = static_cast<Index>(share * static_cast<double>(samples));
        found.push_back(effect({without.cv},
                               {sized(kSine, sd),
                                sized(kCosine, sd),
                                {.quantity = &kFrequency,
                                 .value = frequency,
                                 .prior_mean = frequency,
                                 .prior_sd = resolution,
                                 .step = kFrequencyStep * resolution,
                                 .low = kLeastCycles * resolution,
                                 .high = 0.5 / sample_time_s}},
                               cost + (onset > 0 ? cost_of(kOnsetChoices) : 0.0), onset));
      }
    }
  }

  void square_waves(const Outlook& outlook, const CvFit& without,
                    std::vector<Effect>& found) const {
    const double sample_time_s = outlook.sample_time_s();
    const auto samples = static_cast<double>(outlook.problem.samples());
    const SquareWaves best =
        find_square_waves(outlook.problem.data(without.cv), without, outlook.parallel);
    const double cost =
        cost_of(static_cast<std::size_t>(outlook.model().cv_count)) + cost_of(best.looked_at);
    for (const SquareWave& wave : best.waves) {
      const double period = sample_time_s * wave.period;
      const double begin = sample_time_s * wave.begin;
      const double slip = period * wave.period / samples;
      found.push_back(effect({without.cv},
                             {sized(kSize, left_sd(without)),
                              {.quantity = &kBegin,
                               .value = begin,
                               .prior_mean = begin,
                               .prior_sd = kBeginSd * period,
                               .step = sample_time_s,
                               .low = -kUnboundedSize,
                               .high = kUnboundedSize},
                              {.quantity = &kPeriod,
                               .value = period,
                               .prior_mean = period,
                               .prior_sd = kPeriodSd * slip,
                               .step = slip,
                               .low = 0.5 * period,
                               .high = 2.0 * period}},
                             cost, wave.onset));
    }
  }
};

}  // namespace

const Cause& periodic_disturbance() {
  static const PeriodicDisturbance cause;
  return cause;
}

}  // namespace mpm::causes
