#include "core/identify/diagnosis/account.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/evidence/free_run_residuals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kFitted = 600, kRows = 900;

/// The gain is `fitted` times the model's in the rows that are fitted, `unseen` times in the
/// others.
struct Bench {
  ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  Recording all, first;
  Unseen unseen;
  std::vector<std::optional<double>> shares;
  SearchSettings settings;

  /// From row `rests` on the input stands still.
  Bench(double fitted, double not_fitted, double outside_share, Index rests = kRows)
      : all(plant(fitted, not_fitted, rests)),
        first(part(all, 0, kFitted)),
        unseen(all, kRows - kFitted, model, 1),
        shares{outside_share} {
    settings.progress = [](double) { return true; };
  }

  static Recording plant(double fitted, double not_fitted, Index rests) {
    VectorXd u = test::telegraph(1, kRows, 12);
    u.tail(kRows - rests).setConstant(u[rests - 1]);
    const VectorXd response = test::first_order(u, 2.0, 10.0);
    VectorXd y = response + 0.1 * test::autoregressive(test::normal(3, kRows), 0.5);
    y.head(kFitted) += (fitted - 1.0) * response.head(kFitted);
    y.tail(kRows - kFitted) += (not_fitted - 1.0) * response.tail(kRows - kFitted);
    return test::recording_of(u, y);
  }

  [[nodiscard]] ChannelTests test(const ModelSpec& of, OwnPast past = OwnPast::kLags) const {
    return {model, all, free_run_residuals(of, all), past};
  }
  Account take() {
    const ChannelTests given = test(model);
    return account_for(
        model, 1, first, {unseen, 0, {}, shares},
        {given, given, [this](const ModelSpec& of, OwnPast past) { return test(of, past); }},
        settings);
  }
};

bool names_gain(const Account& account) {
  for (const Named& named : account.found.named)
    if (named.effect.edit == &causes::gain()) return true;
  return false;
}

TEST_CASE("what unseen data refuse goes, with the reason") {
  const Account account = Bench(1.5, 1.0, 1.0).take();
  CHECK_FALSE(names_gain(account));
  REQUIRE_FALSE(account.refused.empty());
  for (const Finding& finding : account.refused) {
    CHECK_FALSE(finding.repaired);
    CHECK_FALSE(finding.refused.empty());
  }
  for (const Fate fate : account.selection.fates) CHECK(fate != Fate::kRefused);
}

TEST_CASE("what carries over stays") {
  const Account account = Bench(1.5, 1.5, 1.0).take();
  CHECK(names_gain(account));
  CHECK(account.refused.empty());
}

TEST_CASE("what the test is sure of is named though the unseen rows hold no movement") {
  const Account account = Bench(1.5, 1.5, 1.0, 530).take();
  CHECK(names_gain(account));
  for (const Fate fate : account.selection.fates) CHECK(fate == Fate::kNoBetter);
}

// Half of the gain is 0.7 of the CV's s.d., far more than the noise: the errors of predictions fall
// to less than half.
TEST_CASE("without the test it is believed where no feedback moves the input, and nowhere else") {
  const auto no_channel = [](const Effect& effect) {
    return !cause_of(effect).acts_through_channels();
  };
  Bench outside(1.5, 1.5, 1.0);
  outside.settings.may_name = no_channel;
  CHECK(names_gain(outside.take()));
  Bench feedback(1.5, 1.5, 0.1);
  feedback.settings.may_name = no_channel;
  const Account account = feedback.take();
  CHECK_FALSE(names_gain(account));
  REQUIRE(account.found.suspect);
  CHECK(account.found.suspect->evidence > 30.0);
}

}  // namespace
}  // namespace mpm
