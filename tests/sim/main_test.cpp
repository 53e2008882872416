#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

namespace {
namespace fs = std::filesystem;

class Folder {
 public:
  Folder()
      : path_(fs::temp_directory_path() / ("mpm_sim_program_test_" + std::to_string(getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream in(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Exit code; stderr goes to the file `err`.
  [[nodiscard]] int run(const std::string& arguments) const {
    const std::string command = std::string(MPM_BIN_DIR) + "/mpmsim " + arguments + " 2>" +
                                file("err") + " >" + file("out");
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  fs::path path_;
};

const std::string kShell = std::string(MPM_SOURCE_DIR) + "/config/plants/shell3x3.yaml";

}  // namespace

TEST_CASE("mpmsim runs a plant of its own equations, and tells what it hides there") {
  const Folder folder;
  const std::string unit = std::string(MPM_SOURCE_DIR) + "/config/plants/recovery_boiler.yaml";
  REQUIRE(folder.run("--config " + unit + " --scenario co_oxidation --samples 50 --csv " +
                     folder.file("run.csv") + " --truth " + folder.file("truth.json")) == 0);
  const std::string csv = folder.read("run.csv"), header = csv.substr(0, csv.find('\n'));
  CHECK(header.find("AI-602.PV") != std::string::npos);
  CHECK(header.find("ZI-501.PV") != std::string::npos);  // aux that the boiler measures
  const nlohmann::json told = nlohmann::json::parse(folder.read("truth.json"));
  CHECK(told["process"]["name"] == "recovery_boiler");
  REQUIRE(told["process"]["changes"].size() == 1);
  CHECK(told["process"]["changes"][0]["quantity"] == "co_oxidation");
  CHECK(told["process"]["changes"][0]["value"] == 1.1);
  // What alters a model is refused where none is simulated.
  CHECK(folder.run("--config " + unit + " --scenario hidden_gain --samples 50 --csv " +
                   folder.file("run.csv")) == 3);
  CHECK(folder.read("err").find("is under `process`") != std::string::npos);
  folder.write("wrong.yaml",
               "process:\n  - {quantity: dry_solids, value: 0.66}\n"
               "  - {quantity: co_oxydation, value: 1.1}\n");
  CHECK(folder.run("--config " + unit + " --scenario " + folder.file("wrong.yaml") +
                   " --samples 50 --csv " + folder.file("run.csv")) == 3);
  CHECK(folder.read("err").find("wrong.yaml:3:5: error: ") != std::string::npos);
  CHECK(folder.read("err").find("no quantity 'co_oxydation'") != std::string::npos);
}

TEST_CASE("mpmsim refuses numbers that are none, in words, and takes no other ones for them") {
  const Folder folder;
  const auto refusal = [&](const std::string& option) {
    CHECK(folder.run("--config " + kShell + " --csv " + folder.file("run.csv") + " " + option) ==
          3);
    const std::string said = folder.read("err");
    return said.substr(0, said.find('\n'));
  };
  CHECK(refusal("--seed -1") == "--seed: '-1' is below 0");
  CHECK(refusal("--seed 18446744073709551616") ==
        "--seed: '18446744073709551616' is too large a number");
  CHECK(refusal("--samples 18446744073709551616") ==
        "--samples: '18446744073709551616' is too large a number");
  CHECK(refusal("--samples -5") == "--samples: '-5' is no number from 0 to 9e+15");
  CHECK(refusal("--limits nan") == "--limits: 'nan' is no number from 0.1 to 1000");
  for (const std::string text : {"nan", "inf", "-1"})
    CHECK(refusal("--speed " + text) == "--speed: '" + text + "' is no number from 0 on");
  CHECK_FALSE(fs::exists(folder.file("run.csv")));
}

TEST_CASE("mpmsim writes a run and its truth, the same for the same seed") {
  const Folder folder;
  const std::string run = "--config " + kShell + " --scenario hidden_gain --samples 200 --seed 5 ";
  REQUIRE(folder.run(run + "--csv " + folder.file("a") + " --truth " + folder.file("t")) == 0);
  REQUIRE(folder.run(run + "--csv " + folder.file("b")) == 0);
  CHECK(folder.read("a") == folder.read("b"));
  CHECK(folder.read("a").rfind("time,sp1,sp2,sp3,u1,u2,u3,y1,y2,y3,yhat1,yhat2,yhat3\n0,", 0) == 0);
  CHECK(folder.read("t").find("gain_ratio") != std::string::npos);
  CHECK(folder.read("err").empty());
  REQUIRE(folder.run(run + "--csv -") == 0);
  CHECK(folder.read("out") == folder.read("a"));
}

TEST_CASE("mpmsim gives the controller another model") {
  const Folder folder;
  std::ifstream in(kShell);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text.replace(text.find("gain: 4.05"), 10, "gain: 5.40");
  folder.write("other.yaml", text);
  const std::string run = "--config " + kShell + " --samples 100 ";
  REQUIRE(folder.run(run + "--csv " + folder.file("a")) == 0);
  REQUIRE(folder.run(run + "--controller-model " + folder.file("other.yaml") + " --csv " +
                     folder.file("b")) == 0);
  CHECK(folder.read("a") != folder.read("b"));
}

TEST_CASE("mpmsim tells bad input from a failed run") {
  const Folder folder;
  CHECK(folder.run("") == 3);
  CHECK(folder.run("--help") == 0);
  CHECK(folder.run("--config /nowhere.yaml --csv x") == 3);
  CHECK(folder.run("--config " + kShell + " --speed -1") == 3);
  CHECK(folder.run("--config " + kShell + " --start-time soon --csv x") == 3);
  CHECK(folder.run("--config " + kShell + " --csv /nowhere/x.csv") == 3);
  const std::string both = folder.file("both");
  CHECK(folder.run("--config " + kShell + " --samples 9 --csv " + both + " --truth " + both) == 3);
  CHECK(folder.read("err") == both + ": error: is given for two outputs\n");
  CHECK_FALSE(fs::exists(both));
  CHECK(folder.run("--config " + kShell + " --scenario nonsense --csv x") == 3);
  CHECK(folder.read("err").find("s3_delay") != std::string::npos);  // lists what there is
  folder.write("s2.yaml", "scenario: s2\nchanges:\n  - {mv: u1, cv: [y1, y2], gain_ratio: 0.75}\n");
  CHECK(folder.run("--config " + kShell + " --scenario " + folder.file("s2.yaml") + " --csv x") ==
        3);
  const std::string told = folder.read("err");
  CHECK(told.find("determinant") != std::string::npos);
  CHECK(told.rfind(folder.file("s2.yaml") + ":3:5: error: changes[0]: no offset-free", 0) == 0);
  CHECK(told.find('\n') == told.size() - 1);  // one line
}

TEST_CASE("mpmsim spoils the reported data and says how") {
  const Folder folder;
  const std::string run = "--config " + kShell + " --samples 400 --csv " + folder.file("a") +
                          " --truth " + folder.file("t") + " ";
  REQUIRE(folder.run(run + "--bad-data missing=20% --bad-data uncertain=5%,tags=y1") == 0);
  CHECK(folder.read("err").empty());
  CHECK(folder.read("a").find("y1,y1.quality,y2") != std::string::npos);
  CHECK(folder.read("a").find(",uncertain,") != std::string::npos);
  CHECK(folder.read("t").find("\"touched\"") != std::string::npos);
  CHECK(folder.run(run + "--bad-data nonsense=3") == 3);
  CHECK(folder.read("err") ==
        "--bad-data: error: give one of missing, uncertain, gaps, frozen, spikes, clipping, "
        "time_jitter, clock_steps\n");
  CHECK(folder.run(run + "--scenario bad_data") == 0);
}

TEST_CASE("mpmsim leaves no half files and follows no links") {
  const Folder folder;
  const std::string run = "--config " + kShell + " --samples 50 ";
  folder.write("victim", "precious");
  fs::create_symlink(folder.file("victim"), folder.file("link"));
  for (const char* option : {"--csv ", "--truth "}) {
    const bool csv = std::string(option) == "--csv ";
    CHECK(folder.run(run + option + folder.file("link") +
                     (csv ? "" : " --csv " + folder.file("a"))) == 3);
    CHECK(folder.read("err").find("/link: error: is a link") != std::string::npos);
  }
  CHECK(folder.read("victim") == "precious");
  CHECK(folder.run(run + "--csv /dev/stdout") == 0);  // a link to a file here
  CHECK(folder.read("out").rfind("time,sp1,", 0) == 0);
  CHECK(folder.run(run + "--csv /dev/full") == 2);
  CHECK(folder.read("err") ==
        "mpmsim: error: /dev/full: cannot be written to: No space left on device\n");
}

TEST_CASE("mpmsim prints materiality limits for the unit file") {
  const Folder folder;
  const std::string run =
      "--config " + std::string(MPM_SOURCE_DIR) + "/config/plants/wood_berry.yaml --limits 50 ";
  REQUIRE(folder.run(run) == 0);
  CHECK(folder.read("out").find("  materiality:\n    channels:") != std::string::npos);
  CHECK(folder.read("out").find("- {cv: xb, mv: steam, gain: 0.") != std::string::npos);
  CHECK(folder.run(run + "--scenario change_delay") == 3);
  CHECK(folder.read("err").find("change_delay") != std::string::npos);
}
