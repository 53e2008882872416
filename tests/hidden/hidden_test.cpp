#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <variant>

#include "core/model/linear_model.hpp"
#include "sim/plant/channel_change.hpp"
#include "tests/hidden/case_setup.hpp"
#include "tests/hidden/hidden_case.hpp"

namespace mpm::hidden {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint64_t kSeed = 200001;

MatrixXd simulate_model(const ModelSpec& spec, const MatrixXd& inputs, double start_s = 0.0) {
  LinearModel model(spec);
  model.set_time_s(start_s);
  MatrixXd result(inputs.rows(), spec.cv_count);
  for (Index k = 0; k < inputs.rows(); ++k) {
    result.row(k) = model.output();
    model.advance(inputs.row(k).transpose());
  }
  return result;
}

CaseRequest request(EffectClass effect_class, const std::string& plant = "shell3x3",
                    Setting setting = Setting::kPlain, std::uint64_t seed = kSeed) {
  return {plant, effect_class, Size::kFull, setting, seed, 1200};
}

/// The model with what the truth says, in the words of the product.
ModelSpec repaired(const HiddenCase& hidden) {
  const TrueEffect& effect = hidden.truth.at(0);
  const auto value = [&](const char* name, double otherwise) {
    const auto place = effect.parameters.find(name);
    return place == effect.parameters.end() ? otherwise : place->second;
  };
  ModelSpec model = hidden.model;
  constexpr double kFar = 1e9;
  if (effect.cause == &causes::input_product()) {
    for (ChannelSpec& channel : model.channels)
      if (channel.cv == effect.place.cv && channel.input == effect.place.input)
        channel.input_block = Product{effect.other_input, value("per_unit", 0.0)};
  } else if (effect.cause->is_input_block()) {
    InputBlock block = Stiction{value("band", 0.0), value("jump", 0.0)};
    if (effect.cause == &causes::deadband()) block = Deadband{value("width", 0.0)};
    if (effect.cause == &causes::input_polynomial())
      block = Polynomial{{1.0, value("quadratic", 0.0), value("cubic", 0.0)}};
    if (effect.cause == &causes::input_saturation())
      block = Saturation{value("low", -kFar), value("high", kFar)};
    const double since_s = effect.onset_s.value_or(hidden.data.start_s);
    if (effect.cause == &causes::input_stuck()) block = Stuck{value("value", 0.0), since_s};
    if (effect.cause == &causes::input_offset()) block = InputOffset{value("size", 0.0), since_s};
    model.input_blocks.resize(static_cast<std::size_t>(model.input_count));
    model.input_blocks[static_cast<std::size_t>(effect.place.input)] = block;
  } else if (effect.cause == &causes::output_saturation()) {
    model.output_blocks.resize(static_cast<std::size_t>(model.cv_count));
    model.output_blocks[static_cast<std::size_t>(effect.place.cv)] =
        Saturation{value("low", -kFar), value("high", kFar)};
  } else {
    std::vector<sim::ChannelChange> changes;
    for (const ChannelSpec& channel : hidden.model.channels)
      if ((effect.place.cv < 0 || channel.cv == effect.place.cv) &&
          (effect.place.input < 0 || channel.input == effect.place.input))
        changes.push_back({channel.cv, channel.input, value("gain_ratio", 1.0),
                           value("time_constant_ratio", 1.0), value("dead_time_error", 0.0)});
    model = sim::changed_model(model, changes);
  }
  return model;
}

double root_mean_square(const MatrixXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

}  // namespace

TEST_CASE("the same request hides the same") {
  for (const EffectClass effect_class :
       {EffectClass::kUnmodelledInput, EffectClass::kTwoCauses, EffectClass::kNoise}) {
    const CaseRequest wanted = request(effect_class, "wood_berry", Setting::kHard);
    const HiddenCase one = draw_case(wanted);
    const HiddenCase other = draw_case(wanted);
    CHECK(one.data.cvs == other.data.cvs);
    CHECK(one.data.inputs == other.data.inputs);
    CHECK(one.data.aux == other.data.aux);
    REQUIRE(one.truth.size() == other.truth.size());
    CHECK(one.truth[0].parameters == other.truth[0].parameters);
    CaseRequest next = wanted;
    ++next.seed;
    CHECK_FALSE(draw_case(next).data.cvs == one.data.cvs);
  }
}

TEST_CASE("where nothing is hidden the plant is the model") {
  for (const char* plant : kPlants) {
    const HiddenCase hidden = draw_case(request(EffectClass::kNone, plant));
    CHECK(hidden.truth.empty());
    const MatrixXd model = simulate_model(hidden.model, hidden.data.inputs);
    CHECK((model - hidden.noise_free).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((model + hidden.noise - hidden.data.cvs).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("with the hard setting every channel is a little wrong") {
  const HiddenCase hidden = draw_case(request(EffectClass::kNone, "shell3x3", Setting::kHard));
  const TruePlantSpec exact = plant_like(hidden.model);
  for (std::size_t i = 0; i < exact.channels.size(); ++i) {
    const double gain = hidden.plant.channels[i].gain / exact.channels[i].gain - 1.0;
    const double lag =
        hidden.plant.channels[i].time_constant / exact.channels[i].time_constant - 1.0;
    CHECK(gain != 0.0);
    CHECK(std::abs(gain) <= 0.04);
    CHECK(lag != 0.0);
    CHECK(std::abs(lag) <= 0.06);
  }
  CHECK(hidden.noise_model[0].pole != hidden.noise_model[1].pole);
}

TEST_CASE("the true plant on the recorded inputs, and the noise, make the data") {
  for (const EffectClass effect_class : kAllClasses) {
    for (const Setting setting : {Setting::kPlain, Setting::kHard}) {
      CAPTURE(name_of(effect_class), setting == Setting::kHard);
      // Of two MVs a controller of two CVs can spare none: with one stuck it winds up.
      const char* unit = effect_class == EffectClass::kInputStuck ? "shell3x3" : "wood_berry";
      const HiddenCase hidden = draw_case(request(effect_class, unit, setting));
      CHECK(hidden.data.cvs.allFinite());
      CHECK(hidden.data.inputs.allFinite());
      TruePlant plant(hidden.plant);
      if (hidden.data.aux.cols() > 0) plant.rest_at(hidden.data.aux.row(0));
      double largest = 0.0;
      for (Index k = 0; k < hidden.data.samples(); ++k) {
        const VectorXd measured = plant.measured(hidden.noise.row(k));
        largest = std::max(largest,
                           (measured - hidden.data.cvs.row(k).transpose()).cwiseAbs().maxCoeff());
        plant.advance(hidden.data.inputs.row(k), hidden.data.aux.row(k));
      }
      CHECK(largest < 1e-12);
      CHECK(hidden.truth.size() == (effect_class == EffectClass::kNone        ? 0U
                                    : effect_class == EffectClass::kTwoCauses ? 2U
                                                                              : 1U));
    }
  }
}

// Also holds the plant's own elements against the model's blocks.
TEST_CASE("a model with what the truth says is the true plant") {
  for (const EffectClass effect_class :
       {EffectClass::kGain, EffectClass::kDeadTime, EffectClass::kTimeConstant,
        EffectClass::kDynamics, EffectClass::kInputScale, EffectClass::kOutputScale,
        EffectClass::kInputNonlinearity, EffectClass::kStiction, EffectClass::kInputStuck,
        EffectClass::kInputOffset, EffectClass::kOutputNonlinearity}) {
    for (std::uint64_t seed = kSeed; seed < kSeed + 6; ++seed) {
      const HiddenCase hidden = draw_case(request(effect_class, "shell3x3", Setting::kPlain, seed));
      const TrueEffect& effect = hidden.truth.at(0);
      CAPTURE(name_of(effect_class), seed, effect.manner);
      if (effect_class == EffectClass::kInputNonlinearity && effect.place.cv >= 0)
        continue;  // one channel's own: not in the model yet
      const MatrixXd with =
          simulate_model(repaired(hidden), hidden.data.inputs, hidden.data.start_s);
      CHECK((with - hidden.noise_free).cwiseAbs().maxCoeff() < 1e-9);
      const MatrixXd without = simulate_model(hidden.model, hidden.data.inputs);
      CHECK(root_mean_square(without - hidden.noise_free) > 1e-4);
    }
  }
}

TEST_CASE("an onset changes nothing before it") {
  for (const EffectClass effect_class : {EffectClass::kOnsetGain, EffectClass::kOnsetDeadTime,
                                         EffectClass::kStep, EffectClass::kDrift}) {
    for (const Setting setting : {Setting::kPlain, Setting::kHard}) {
      const HiddenCase hidden = draw_case(request(effect_class, "shell3x3", setting));
      const TrueEffect& effect = hidden.truth.at(0);
      REQUIRE(effect.onset_s);
      const auto onset = static_cast<Index>(
          std::llround((*effect.onset_s - hidden.data.start_s) / hidden.data.sample_time_s));
      CHECK(onset > 0);
      CHECK(onset < hidden.fit_samples());
      const MatrixXd healthy = simulate(hidden.healthy_plant, hidden.data.inputs, hidden.data.aux);
      const MatrixXd difference = hidden.noise_free - healthy;
      CHECK(difference.topRows(onset).cwiseAbs().maxCoeff() < 1e-12);
      CHECK(difference.col(effect.place.cv)
                .tail(hidden.data.samples() - onset)
                .cwiseAbs()
                .maxCoeff() > 1e-3);
    }
  }
}

TEST_CASE("half size is half the deviation of the same draw") {
  CaseRequest wanted = request(EffectClass::kGain);
  const HiddenCase full = draw_case(wanted);
  wanted.size = Size::kHalf;
  const HiddenCase half = draw_case(wanted);
  REQUIRE(full.attempts == half.attempts);
  CHECK(half.truth[0].place.cv == full.truth[0].place.cv);
  CHECK(half.truth[0].place.input == full.truth[0].place.input);
  CHECK(half.truth[0].parameters.at("gain_ratio") - 1.0 ==
        Approx(0.5 * (full.truth[0].parameters.at("gain_ratio") - 1.0)));
}

TEST_CASE("an unmodelled input comes with signals that do nothing") {
  const HiddenCase hidden = draw_case(request(EffectClass::kUnmodelledInput));
  REQUIRE(hidden.data.aux.cols() >= 2);
  MatrixXd aux = hidden.data.aux;
  for (Index i = 0; i < aux.cols(); ++i)
    if (i != hidden.truth[0].place.aux) aux.col(i).setConstant(-1000.0);
  CHECK(simulate(hidden.plant, hidden.data.inputs, aux) == hidden.noise_free);
}

TEST_CASE("a valve that sticks, by hand") {
  // Band 4, jump 2: breaks away beyond 3 from where it stands, then follows 1 behind.
  RunningElement follows(Sticking{4.0, 2.0, false});
  CHECK(follows.next(3.0) == 0.0);
  CHECK(follows.next(3.5) == 2.5);
  CHECK(follows.next(4.0) == 3.0);
  CHECK(follows.next(4.0) == 3.0);
  CHECK(follows.next(1.0) == 3.0);
  CHECK(follows.next(-0.5) == 0.5);
  RunningElement slips(Sticking{4.0, 2.0, true});
  CHECK(slips.next(3.5) == 2.5);
  CHECK(slips.next(4.0) == 2.5);
  CHECK(slips.next(6.0) == 5.0);
}

TEST_CASE("noise has the level and colour that its model says") {
  CvNoise noise;
  noise.sigma = 0.1;
  noise.pole = 0.9;
  noise.moving = 0.4;
  noise.variance_ratio = 9.0;
  noise.onset = 100000;
  const VectorXd values = draw_noise({noise}, 200000, 1).col(0);
  CHECK(root_mean_square(values.head(100000)) == Approx(noise.deviation()).epsilon(0.03));
  CHECK(root_mean_square(values.tail(99000)) == Approx(3.0 * noise.deviation()).epsilon(0.03));
  CHECK(evidence(noise, values.head(100000)) == Approx(100000.0).epsilon(0.02));
  CHECK(evidence(noise, VectorXd::Constant(1000, 0.5)) == Approx(0.0).margin(1e-9));
  CHECK(evidence(noise, values.head(1000), {values.head(1000)}) == Approx(0.0).margin(1e-9));
}

}  // namespace mpm::hidden
