#include "core/identify/causes/catalog.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "tests/core/identify/proposals.hpp"

namespace mpm {
namespace {

std::string text_of(const Cause& cause) {
  return std::string(cause.name().text) + ' ' + cause.kind();
}

SignalNames names() {
  return {{{"u1", "%"}, {"u2", "kg/s"}},
          {{"t_amb", "K"}},
          {{"y1", "m"}, {"y2", "K"}},
          test::open_problem().model()};
}

// The words of the reports' contract.
TEST_CASE("causes are called what the reports call them") {
  const std::pair<const Cause*, std::pair<const char*, const char*>> words[] = {
      {&causes::gain(), {"gain", ""}},
      {&causes::dead_time(), {"dead_time", ""}},
      {&causes::time_constant(), {"time_constant", ""}},
      {&causes::dynamics(), {"dynamics", ""}},
      {&causes::input_scale(), {"input_scale", ""}},
      {&causes::output_scale(), {"output_scale", ""}},
      {&causes::input_polynomial(), {"input_nonlinearity", "polynomial"}},
      {&causes::input_saturation(), {"input_nonlinearity", "saturation"}},
      {&causes::input_two_sided(), {"input_nonlinearity", "two_sided"}},
      {&causes::input_product(), {"input_nonlinearity", "product"}},
      {&causes::deadband(), {"input_nonlinearity", "deadband"}},
      {&causes::stiction(), {"stiction", ""}},
      {&causes::input_stuck(), {"input_stuck", ""}},
      {&causes::input_offset(), {"input_offset", ""}},
      {&causes::output_saturation(), {"output_nonlinearity", "saturation"}},
      {&causes::unmodelled_input(), {"unmodelled_input", ""}},
      {&causes::step_disturbance(), {"output_disturbance", "step"}},
      {&causes::drift_disturbance(), {"output_disturbance", "drift"}},
      {&causes::periodic_disturbance(), {"output_disturbance", "periodic"}},
      {&causes::noise(), {"noise", ""}},
      {&causes::cubic_stiffness(), {"state_nonlinearity", "cubic_stiffness"}},
      {&causes::square_root_outflow(), {"state_nonlinearity", "square_root_outflow"}},
      {&causes::coulomb_friction(), {"state_nonlinearity", "coulomb_friction"}},
      {&causes::unnamed_swing(), {"unnamed", "swing"}},
      {&causes::unnamed_direction(), {"unnamed", "direction"}},
  };
  CHECK(std::size(words) == causes::all().size());
  for (const auto& [cause, word] : words) {
    CAPTURE(word.first, word.second);
    CHECK(std::string(cause->name().text) == word.first);
    CHECK(std::string(cause->kind()) == word.second);
    CHECK(causes::find(word.first, word.second) == cause);
  }
  CHECK(std::string(causes::step_disturbance().name().kind_key) == "shape");
  CHECK(std::string(causes::cubic_stiffness().name().kind_key) == "term");
  CHECK(std::string(causes::deadband().name().kind_key) == "kind");
}

TEST_CASE("each row of the table is one cause with a title") {
  std::set<std::pair<std::string, std::string>> words;
  std::set<const Cause*> objects;
  for (const Cause* cause : causes::all()) {
    CAPTURE(text_of(*cause));
    CHECK(objects.insert(cause).second);
    CHECK(words.emplace(cause->name().text, cause->kind()).second);
    CHECK_FALSE(std::string(cause->name().title).empty());
    CHECK(causes::is_unnamed(*cause) == (std::string(cause->name().text) == "unnamed"));
  }
  // Without a kind, the first of those that share a name.
  CHECK(causes::find("input_nonlinearity") == &causes::input_polynomial());
  CHECK(causes::find("output_disturbance") == &causes::step_disturbance());
  CHECK(causes::find("wear") == nullptr);
  CHECK(causes::find("gain", "step") == nullptr);
}

TEST_CASE("errors of channels are expected, anything else is rarer and the unnamed rarest") {
  for (const Cause* cause : {&causes::gain(), &causes::dead_time(), &causes::time_constant(),
                             &causes::dynamics(), &causes::input_scale(), &causes::output_scale()})
    CHECK(cause->rarity() == 0.0);
  // As 2 ln of odds: 1 to 12, 1 to 24, 1 to 1000.
  for (const Cause* cause :
       {&causes::input_polynomial(), &causes::input_saturation(), &causes::input_two_sided(),
        &causes::input_product(), &causes::deadband(), &causes::stiction(),
        &causes::output_saturation(), &causes::unmodelled_input(), &causes::step_disturbance(),
        &causes::drift_disturbance(), &causes::periodic_disturbance()})
    CHECK(std::exp(0.5 * cause->rarity()) == Approx(12.0));
  for (const Cause* cause :
       {&causes::cubic_stiffness(), &causes::square_root_outflow(), &causes::coulomb_friction()})
    CHECK(std::exp(0.5 * cause->rarity()) == Approx(24.0));
  for (const Cause* cause : {&causes::unnamed_swing(), &causes::unnamed_direction()})
    CHECK(std::exp(0.5 * cause->rarity()) == Approx(1000.0));
}

TEST_CASE("what is slow and without an edge may pass for noise") {
  CHECK(causes::unmodelled_input().may_pass_for_noise());
  CHECK(causes::drift_disturbance().may_pass_for_noise());
  CHECK(causes::periodic_disturbance().may_pass_for_noise());
  CHECK_FALSE(causes::step_disturbance().may_pass_for_noise());
  CHECK_FALSE(causes::gain().may_pass_for_noise());
}

// A change of the noise is no edit of a model: it is looked for in what the last fit leaves.
TEST_CASE("every cause proposes effects of its own, begun within their bounds") {
  for (const Cause* cause : causes::all()) {
    CAPTURE(text_of(*cause));
    const std::vector<Effect> proposals = test::proposals_of(*cause);
    CHECK(proposals.empty() == (cause == &causes::noise()));
    for (const Effect& effect : proposals) {
      CHECK(effect.edit == cause);
      CHECK(effect.search_cost >= 0.0);
      CHECK_FALSE(effect.coordinates.empty());
      CHECK_FALSE(touched(effect, test::open_problem()).empty());
      for (const Coordinate& coordinate : effect.coordinates) {
        CAPTURE(coordinate.quantity->name);
        CHECK(effect.find(*coordinate.quantity, coordinate.number) == &coordinate);
        CHECK(coordinate.low <= coordinate.value);
        CHECK(coordinate.value <= coordinate.high);
        CHECK(coordinate.prior_sd > 0.0);
        CHECK(coordinate.step != 0.0);
      }
    }
  }
}

TEST_CASE("the model with what a cause proposes can be simulated") {
  Problem& problem = test::open_problem();
  for (const Cause* cause : causes::all())
    for (const Effect& effect : test::proposals_of(*cause))
      for (const int cv : touched(effect, problem)) {
        CAPTURE(text_of(*cause), cv);
        CHECK(problem.simulate({effect}, cv).allFinite());
      }
}

/// Sentences one after the other, each with a space behind it.
bool reads_on(const std::string& text) {
  return text.size() > 2 && text.compare(text.size() - 2, 2, ". ") == 0 &&
         text.find("  ") == std::string::npos && text.find("nan") == std::string::npos;
}

TEST_CASE("every finding is said in whole sentences") {
  for (const Cause* cause : causes::all()) {
    const std::vector<Finding> findings = test::findings_of(*cause);
    CHECK_FALSE(findings.empty());
    for (const Finding& finding : findings) {
      const std::string text = cause->sentence(finding, names());
      CAPTURE(text_of(*cause), text);
      CHECK(finding.subject.cause == cause);
      if (causes::is_unnamed(*cause))
        CHECK(text.rfind(", whose effect seems ", 0) == 0);  // goes on with another sentence
      else
        CHECK(reads_on(text));
    }
  }
}

// Errors of one channel are nothing but their numbers.
TEST_CASE("a finding without its numbers is still said") {
  for (const Cause* cause : causes::all()) {
    Finding finding = test::findings_of(*cause).front();
    finding.parameters.clear();
    const std::string text = cause->sentence(finding, names());
    CAPTURE(text_of(*cause), text);
    CHECK(text.empty() == (cause->together_with_others() != nullptr));
    if (!text.empty() && !causes::is_unnamed(*cause)) CHECK(reads_on(text));
  }
}

}  // namespace
}  // namespace mpm
