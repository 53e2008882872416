#include "tests/boiler/story.hpp"

#include <algorithm>
#include <set>

#include "tests/boiler/samples.hpp"
#include "tests/boiler/unit_texts.hpp"
#include "tests/system/process.hpp"

namespace mpm::boiler {
namespace {

const std::string kScenarios = "config/plants/scenarios/";
const std::string kPlantNow = "plant_now.yaml";

class Player {
 public:
  Player(Workshop& workshop, const StoryPlan& plan) : workshop_(workshop) { story_.plan = plan; }

  Story play() {
    make_model();
    const StoryPlan& plan = story_.plan;
    story_.others.resize(plan.others.size());
    std::vector<std::function<void()>> tasks = {[this] { follow_change(); }};
    for (std::size_t i = 0; i < plan.others.size(); ++i)
      tasks.emplace_back([this, i] { hide(story_.others[i], story_.plan.others[i]); });
    tasks.emplace_back([this] {
      story_.healthy = live("healthy", "none", story_.plan.watch);
      story_.healthy_diagnosis =
          diagnosed("healthy", story_.healthy.recording, story_.healthy.commands);
    });
    tasks.emplace_back([this] {
      story_.commissioned = live("commissioned", "none", story_.plan.compare);
      story_.mismatch = live("mismatch", "co_oxidation", story_.plan.compare);
    });
    two_at_a_time(tasks);
    return std::move(story_);
  }

 private:
  std::string run(std::vector<Command>& made, Command command) {
    made.push_back(command);
    return workshop_.run(command);
  }

  [[nodiscard]] static Command simulated(const std::string& plant, const std::string& scenario,
                                         int samples, std::uint64_t seed, const std::string& csv) {
    return {"mpmsim",
            "--config",
            plant,
            "--scenario",
            scenario,
            "--samples",
            std::to_string(samples),
            "--seed",
            std::to_string(seed),
            "--csv",
            csv};
  }

  /// Rest, test, model from tags alone, and other data to judge it by.
  void make_model() {
    const StoryPlan& plan = story_.plan;
    test::write_file("rest.yaml", "scenario: rest\ncontroller: {off: [{from: 0}]}\n");
    story_.rest = "rest.csv";
    run(story_.made_rest, simulated(kPlant, "rest.yaml", plan.rest, plan.seed, story_.rest));
    test::write_file("tags.yaml", tags_alone(test::read_file(kPlant)));
    story_.test = "test.csv";
    run(story_.made_model, simulated(kPlant, "identification", plan.test, plan.seed, story_.test));
    story_.identified =
        Json::parse(run(story_.made_model, {"mpm", "identify", "--config", "tags.yaml", "--data",
                                            story_.test, "--out", kCommissionedModel, "--json"}));
    story_.validation = "validation.csv";
    run(story_.made_validation,
        simulated(kPlant, "identification", plan.test / 3, plan.seed + 1, story_.validation));
  }

  LiveRun live(const std::string& name, const std::string& scenario, int samples,
               const std::string& model = kCommissionedModel) {
    return play_live(workshop_, {name, scenario, model, samples, story_.plan.seed});
  }

  Json diagnosed(const std::string& name, const std::string& recording,
                 std::vector<Command>& made) {
    const std::string out = "report_" + name;
    run(made, {"mpm", "diagnose", "--config", kCommissionedModel, "--data", recording, "--out", out,
               "--threads", "1", "--quiet"});
    return Json::parse(test::read_file(out + "/report.json"));
  }

  /// The thesis's change: seen, diagnosed, re-identified where the findings point and the plant now
  /// rests, and controlled again.
  void follow_change() {
    story_.changed = live("changed", "co_oxidation", story_.plan.watch);
    story_.diagnosis = diagnosed("changed", story_.changed.recording, story_.made_diagnosis);
    name_cvs();
    repair();
    story_.repaired = live("repaired", "co_oxidation", story_.plan.compare, kRepairedModel);
  }

  void name_cvs() {
    std::set<std::string> named;
    for (const Json& finding : story_.diagnosis["findings"])
      if (finding["cv"].is_string()) named.insert(finding["cv"].get<std::string>());
    story_.suspected_cvs.assign(named.begin(), named.end());
  }

  void repair() {
    const std::vector<std::string>& cvs = story_.suspected_cvs;
    if (cvs.empty()) {
      test::write_file(kRepairedModel, test::read_file(kCommissionedModel));
      return;
    }
    test::write_file("test_on_changed_plant.yaml",
                     test_on_changed_plant(test::read_file(kScenarios + "identification.yaml"),
                                           test::read_file(kScenarios + "co_oxidation.yaml")));
    const std::string here = "test_on_changed_plant.yaml";
    test::write_file("suspected_tags.yaml", tags_alone(test::read_file(kPlant), cvs));
    std::vector<double> means;
    for (const report::Series& mv : samples_of(story_.changed.recording, unit_of(kPlant)).mvs)
      means.push_back(mean_of(mv));
    test::write_file(kPlantNow, resting_at(kPlant, means, here));
    for (const double at : unit_of(kPlantNow).model.input_origin) story_.test_point.push_back(at);
    run(story_.made_repair,
        simulated(kPlantNow, here, story_.plan.test, story_.plan.seed + 2, "test_again.csv"));
    story_.identified_again =
        Json::parse(run(story_.made_repair,
                        {"mpm", "identify", "--config", "suspected_tags.yaml", "--data",
                         "test_again.csv", "--out", "suspected.yaml", "--threads", "1", "--json"}));
    test::write_file(kRepairedModel, with_channels_of(kCommissionedModel, "suspected.yaml", cvs));
  }

  void hide(HiddenChange& change, const std::string& scenario) {
    change.scenario = scenario;
    change.description = description_of(test::read_file(kScenarios + scenario + ".yaml"));
    change.run = live(scenario, scenario, story_.plan.watch);
    change.diagnosis = diagnosed(scenario, change.run.recording, change.run.commands);
    if (scenario != story_.plan.seen_by_aux) return;
    // The same numbers as a historian has them: the bus carries no auxiliary measurements.
    const std::string csv = scenario + ".csv";
    Command command = simulated(kPlant, scenario, story_.plan.watch, story_.plan.seed, csv);
    command.insert(command.end(), {"--controller-model", kCommissionedModel});
    run(change.run.commands, command);
    change.with_aux = diagnosed(scenario + "_aux", csv, change.run.commands);
  }

  Workshop& workshop_;
  Story story_;
};

}  // namespace

Story play(Workshop& workshop, const StoryPlan& plan) {
  const auto start = std::chrono::steady_clock::now();
  Story story = Player(workshop, plan).play();
  story.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return story;
}

}  // namespace mpm::boiler
