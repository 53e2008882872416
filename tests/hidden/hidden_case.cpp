#include "tests/hidden/hidden_case.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "tests/hidden/aux_signals.hpp"
#include "tests/hidden/case_checks.hpp"
#include "tests/hidden/case_setup.hpp"
#include "tests/hidden/loop.hpp"

namespace mpm::hidden {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kMostAttempts = 300;
constexpr double kVisibleFull = 100.0, kVisibleHalf = 25.0;
constexpr double kPartVisibleFull = 60.0, kPartVisibleHalf = 25.0;
constexpr double kUsualSamples = 3000.0;  ///< that these are for; fewer cannot say as much

/// One number for all of a request but its size, so that half-size cases are full ones made
/// smaller.
std::uint64_t seed_of(const CaseRequest& request) {
  std::uint64_t plant = 0;
  for (const char letter : request.plant) plant = 31 * plant + static_cast<unsigned char>(letter);
  const auto effect_class = static_cast<std::uint64_t>(request.effect_class);
  const auto setting = static_cast<std::uint64_t>(request.setting);
  return ((request.seed * 64 + effect_class) * 4 + setting) * 1000003 + plant % 1000003;
}

/// Two different ones for two_causes.
std::vector<EffectClass> classes_of(Draft& draft, EffectClass effect_class) {
  if (effect_class == EffectClass::kNone) return {};
  if (effect_class != EffectClass::kTwoCauses) return {effect_class};
  const auto draw = [&draft] {
    return kSingleCauses[static_cast<std::size_t>(
        draft.below(static_cast<int>(kSingleCauses.size())))];
  };
  const EffectClass first = draw();
  return {first, draw()};
}

int draw_aux_count(Draft& draft, const std::vector<EffectClass>& classes) {
  const int decoys = 1 + draft.below(2);
  const bool some = draft.chance(0.5);
  const auto needed = std::count(classes.begin(), classes.end(), EffectClass::kUnmodelledInput) > 0;
  return needed ? 1 + decoys : some ? decoys : 0;
}

/// All that attempts at one case have in common.
struct Case {
  const CaseRequest& request;
  config::UnitConfig unit;
  std::uint64_t seed;
  TruePlantSpec exact;
  std::vector<CvNoise> noise_model;
  Surroundings around;
  LoopRecord usual;
  Healthy healthy;

  explicit Case(const CaseRequest& request_)
      : request(request_), unit(load_plant(request.plant)), seed(seed_of(request)) {
    exact = plant_like(unit.model);
    exact.disturbance = MatrixXd::Zero(request.samples, exact.cv_count);
    noise_model = draw_noise_model(unit, is_hard(), seed);
    around.noise = draw_noise(noise_model, request.samples, seed);
    around.dvs = draw_dvs(unit, exact, request.samples, seed);
    around.aux.resize(request.samples, 0);
    usual = run_loop(unit, exact, around, seed);
    healthy = summarise_healthy(usual, exact, static_cast<int>(unit.mv.size()));
  }
  [[nodiscard]] bool is_hard() const { return request.setting == Setting::kHard; }
  [[nodiscard]] Draft blank(int attempt) const {
    return {.unit = unit,
            .healthy = healthy,
            .size = request.size == Size::kFull ? 1.0 : 0.5,
            .hard = is_hard(),
            .samples = request.samples,
            .fit_samples = 2 * request.samples / 3,
            .start_s = request.seed % 2 == 0 ? 0.0 : 86400.0,
            .stream = sim::RandomStream(seed, sim::StreamPurpose::kHiddenChange,
                                        static_cast<std::uint64_t>(attempt)),
            .plant = exact,
            .noise = noise_model,
            .aux = {}};
  }
};

bool all_visible(const Draft& draft, const std::vector<double>& evidence, double least) {
  for (std::size_t i = 0; i < evidence.size(); ++i)
    if (draft.truth[i].cause != &causes::noise() && evidence[i] < least) return false;
  return true;
}

std::optional<HiddenCase> attempt_case(const Case& all, int attempt) {
  Draft draft = all.blank(attempt);
  const std::vector<EffectClass> classes = classes_of(draft, all.request.effect_class);
  draft.aux = add_aux_signals(draft.plant, draw_aux_count(draft, classes), draft.samples, all.seed,
                              static_cast<std::uint64_t>(attempt));
  std::vector<TruePlantSpec> stages = {draft.plant};
  for (const EffectClass effect_class : classes) {
    hide(draft, effect_class);
    stages.push_back(draft.plant);
  }
  if (draft.truth.size() == 2 && !separable(draft.truth[0], draft.truth[1])) return std::nullopt;
  if (draft.hard)
    for (TruePlantSpec& stage : stages)
      add_background(stage, draft.truth, all.seed, static_cast<std::uint64_t>(attempt));
  if (!is_stabilisable(all.unit, all.exact, stages.back())) return std::nullopt;

  Surroundings around = all.around;
  around.noise = draw_noise(draft.noise, draft.samples, all.seed);
  around.aux = draft.aux;
  LoopRecord record = run_loop(all.unit, stages.back(), around, all.seed);
  if (runs_away(record, all.usual, all.exact) || !clips_in_measure(draft, record.cvs))
    return std::nullopt;
  std::vector<double> seen = evidence_of(draft, stages, record, around);
  const double less = std::min(1.0, draft.samples / kUsualSamples);
  const bool full = all.request.size == Size::kFull;
  if (!all_visible(draft, seen, less * (full ? kVisibleFull : kVisibleHalf))) return std::nullopt;
  if (all.request.effect_class == EffectClass::kDynamics &&
      weakest_part(draft, stages.front(), stages.back(), record, around) <
          less * (full ? kPartVisibleFull : kPartVisibleHalf))
    return std::nullopt;

  HiddenCase result;
  result.request = all.request;
  result.model = all.unit.model;
  result.mv_count = draft.mv_count();
  result.noise_free = simulate(stages.back(), record.inputs, around.aux);
  result.data = {draft.start_s, all.unit.sample_time_s, std::move(record.inputs),
                 std::move(record.cvs), std::move(around.aux)};
  result.truth = std::move(draft.truth);
  result.noise = std::move(around.noise);
  result.noise_model = std::move(draft.noise);
  result.plant = stages.back();
  result.healthy_plant = stages.front();  // the same one where nothing is hidden
  result.evidence = std::move(seen);
  result.attempts = attempt;
  return result;
}

}  // namespace

HiddenCase draw_case(const CaseRequest& request) {
  const Case all(request);
  for (int attempt = 1; attempt <= kMostAttempts; ++attempt)
    if (std::optional<HiddenCase> result = attempt_case(all, attempt)) return *std::move(result);
  throw std::runtime_error("no draw of " + std::string(name_of(request.effect_class)) + " on " +
                           request.plant + " was fit, seed " + std::to_string(request.seed));
}

}  // namespace mpm::hidden
