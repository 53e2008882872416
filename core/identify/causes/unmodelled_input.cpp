#include <algorithm>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/causes/spread.hpp"
#include "core/identify/causes/unmodelled_input.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/text/number_text.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kUnmodelledInputName{"unmodelled_input", "Input that the model leaves out"};

constexpr Quantity kGain{"gain", Form::kPlain, Unit::kCvPerInput};
constexpr Quantity kTimeConstant{"time_constant", Form::kLog, Unit::kSeconds};
constexpr Quantity kDeadTime{"dead_time", Form::kSamples, Unit::kSeconds};

/// s.d. of the gain: the signal would move the CV by so much of its own s.d.
constexpr double kUsualGain = 0.5;
/// Time constants and dead times to begin a fit from, in slowest time constants of the CV.
constexpr double kTimeConstants[] = {0.05, 0.2, 0.6, 1.5, 4.0};
constexpr double kDeadTimes[] = {0.0, 0.2};
/// s.d. of the log of the time constant, about half the slowest one; of the dead time, in slowest
/// time constants and samples on top.
constexpr double kTimeConstantSd = 1.2;
constexpr double kDeadTimeSd = 0.3, kDeadTimeSamplesSd = 3.0;
/// What they never pass: samples, slowest time constants.
constexpr double kFastest = 0.2, kSlowest = 30.0, kLatest = 5.0;
/// A CV of which the model knows no time constant settles within so many samples.
constexpr double kUnmodelledInputUsualSamples = 10.0;

bool is_setpoint(const Recording& recording, const Place& place) {
  return place.aux >= 0 && place.aux >= first_setpoint(recording);
}

/// A measured signal acts on a CV that the model does not connect it to.
class UnmodelledInput : public Cause {
 public:
  UnmodelledInput() : Cause(kUnmodelledInputName) {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    TransferFunction transfer;
    transfer.gain = effect.value(kGain, 0.0);
    transfer.time_constants_s = {std::exp(effect.value(kTimeConstant, 0.0))};
    transfer.dead_time_s =
        std::max(0.0, effect.value(kDeadTimeError, 0.0) * surroundings.sample_time_s);
    const Place& place = effect.place;
    const int input = place.aux >= 0 ? surroundings.model_inputs + place.aux : place.input;
    model.channels.push_back({place.cv, input, transfer, {}});
  }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const std::vector<Place> places = unconnected(outlook);
    for (const Place& place : places) {
      const double slowest =
          slowest_of_cv_s(outlook.model(), place.cv, kUnmodelledInputUsualSamples);
      for (const double share : kTimeConstants)
        for (const double delay : kDeadTimes) {
          const double time_constant_s = std::max(0.5 * outlook.sample_time_s(), share * slowest);
          if (const auto effect =
                  at(outlook.problem, place, places.size(), time_constant_s, delay * slowest))
            found.push_back(*effect);
        }
    }
  }

  [[nodiscard]] std::optional<Effect> at(const Problem& problem, const Place& place,
                                         std::size_t members, double time_constant_s,
                                         double dead_time_s) const {
    const Recording& recording = problem.recording();
    const std::optional<Spread> from = spread_of(
        place.aux >= 0 ? recording.aux.col(place.aux) : recording.inputs.col(place.input));
    const std::optional<Spread> to = spread_of(recording.cvs.col(place.cv));
    if (!from || !to) return std::nullopt;
    const double sample_time_s = problem.surroundings().sample_time_s;
    const double slowest = slowest_of_cv_s(problem.model(), place.cv, kUnmodelledInputUsualSamples);
    const double gain = kUsualGain * to->sd / std::max(1e-12, from->sd);
    return effect(place,
                  {{.quantity = &kGain,
                    .prior_sd = gain,
                    .step = 0.01 * gain,
                    .low = -kUnbounded,
                    .high = kUnbounded},
                   {.quantity = &kTimeConstant,
                    .value = std::log(time_constant_s),
                    .prior_mean = std::log(slowest / 2.0),
                    .prior_sd = kTimeConstantSd,
                    .step = 0.02,
                    .low = std::log(kFastest * sample_time_s),
                    .high = std::log(kSlowest * slowest)},
                   {.quantity = &kDeadTimeError,
                    .value = dead_time_s / sample_time_s,
                    .prior_sd = kDeadTimeSd * slowest / sample_time_s + kDeadTimeSamplesSd,
                    .step = 0.25,
                    .low = 0.0,
                    .high = kLatest * slowest / sample_time_s}},
                  cost_of(members) + (is_setpoint(recording, place) ? kSetpointRarity : 0.0));
  }

  [[nodiscard]] bool may_pass_for_noise() const override { return true; }
  [[nodiscard]] bool names_its_source() const override { return true; }

  /// The model has no dead time here that it could be an error of.
  void restate(const Effect&, const Problem&, Finding& finding) const override {
    for (Parameter& parameter : finding.parameters)
      if (parameter.quantity == &kDeadTimeError) parameter.quantity = &kDeadTime;
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    std::string text = names.cv(place.cv).tag + " follows " + names.source(place).tag +
                       (place.aux >= 0 ? ", a signal that the model leaves out"
                                       : ", to which the model does not connect it");
    if (const Parameter* gain = finding.find(kGain)) {
      const std::string per = names.unit_text(Unit::kCvPerInput, place);
      text += ": gain " + number_text(gain->value) + (per.empty() ? "" : " " + per) + " (" +
              interval_of(*gain) + ")";
    }
    if (const Parameter* lag = finding.find(kTimeConstant))
      text += ", time constant " + number_text(lag->value) + " s";
    if (const Parameter* delay = finding.find(kDeadTime))
      text += ", dead time " + number_text(delay->value) + " s";
    return text + ". ";
  }

 private:
  static std::vector<Place> unconnected(const Outlook& outlook) {
    std::vector<Place> places;
    const auto aux = static_cast<int>(outlook.recording().aux.cols());
    for (int cv = 0; cv < outlook.model().cv_count; ++cv) {
      for (int input = 0; input < outlook.inputs(); ++input) {
        const std::vector<int> cvs = outlook.cvs_of(input);
        if (std::find(cvs.begin(), cvs.end(), cv) == cvs.end()) places.push_back({cv, input});
      }
      for (int a = 0; a < aux; ++a) places.push_back({cv, -1, a});
    }
    return places;
  }
};

const UnmodelledInput& the_cause() {
  static const UnmodelledInput cause;
  return cause;
}

}  // namespace

const Cause& unmodelled_input() { return the_cause(); }

std::optional<Effect> unmodelled_input_at(const Problem& problem, const Place& place,
                                          std::size_t members, double time_constant_s,
                                          double dead_time_s) {
  return the_cause().at(problem, place, members, time_constant_s, dead_time_s);
}

}  // namespace mpm::causes
