#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "daemon/bag/mcap_frame_writer.hpp"
#include "tests/daemon/bag/bench.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

TEST_CASE("The programs: exit codes, files, messages") {
  Bench bench;
  const auto mpm = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "mpm");
    return run(arguments, bench.folder.file("out"), bench.folder.file("err")).value_or(-1);
  };
  const auto path = [&](const char* name) { return bench.folder.file(name); };
  bag::McapFrameWriter a(path("a.mcap"), bench.unit, all_columns());
  for (const Frame& frame : any_frames(bench.unit, 300)) a.write(frame);
  a.finish();
  CHECK(mpm({"info", path("a.mcap"), "--json"}) == 0);
  const auto json = nlohmann::json::parse(bench.text("out"));
  CHECK(json["index"] == "intact");
  CHECK(json["units"][0]["unit"] == "small");
  CHECK(mpm({"convert", path("a.mcap"), path("a.csv"), "--time-zone", "Europe/Berlin"}) == 0);
  CHECK(bench.text("out").find("300 rows of 7 signals") != std::string::npos);
  CHECK(mpm({"convert", path("a.csv"), path("b.mcap"), "--config", path("small.yaml")}) == 0);
  CHECK(mpm({"convert", path("a.mcap"), path("b.csv"), "--time-zone", "Mars/Base"}) == 3);
  CHECK(mpm({"convert", path("a.mcap"), path("b.csv"), "--layout", "tall"}) == 3);
  CHECK_FALSE(std::filesystem::exists(path("b.csv")));
  const std::string bytes = bench.text("a.mcap");
  write_file(path("torn.mcap"), bytes.substr(0, bytes.size() / 2));
  CHECK(mpm({"detect", "--config", path("small.yaml"), "--data", path("torn.mcap")}) == 3);
  CHECK(lines_of(bench.text("err")).back().find("torn.mcap: error: byte ") != std::string::npos);
  CHECK(bench.text("err").find("mpm recover") != std::string::npos);
  CHECK(mpm({"recover", path("torn.mcap")}) == 0);
  CHECK(std::filesystem::exists(path("torn.recovered.mcap")));
  CHECK(mpm({"info", path("torn.recovered.mcap")}) == 0);
  CHECK(mpm({"recover", path("a.csv")}) == 3);
  CHECK(mpm({"info", path("none.mcap")}) == 3);
}

TEST_CASE("mpm convert - writes CSV to standard output and what it has to tell beside it") {
  Bench bench;
  const auto path = [&](const char* name) { return bench.folder.file(name); };
  bag::McapFrameWriter a(path("a.mcap"), bench.unit, all_columns());
  for (const Frame& frame : any_frames(bench.unit, 30)) a.write(frame);
  a.finish();
  REQUIRE(run({"mpm", "convert", path("a.mcap"), path("a.csv")}, path("out"), path("err")) == 0);
  REQUIRE(run({"mpm", "convert", path("a.mcap"), "-"}, path("out"), path("err")) == 0);
  CHECK(bench.text("out") == bench.text("a.csv"));
  CHECK(bench.text("err").find("30 rows of 7 signals") != std::string::npos);
  CHECK(bench.text("err").find(std::to_string(bench.text("a.csv").size()) + " bytes") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists("-"));
}

TEST_CASE("a choice of time holds for what is told and for what is converted") {
  Bench bench;
  const auto path = [&](const char* name) { return bench.folder.file(name); };
  const auto mpm = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "mpm");
    return run(arguments, path("out"), path("err")).value_or(-1);
  };
  // Minutes 0 to 59, of which 20 to 24 are not there.
  std::string text = "time,u,\"d,1\",y,z,yhat,sp\n";
  for (int k = 0; k < 60; ++k)
    if (k < 20 || k >= 25)
      text += std::to_string(60 * k) + "," + std::to_string(k) + ",1,2,3,4,5\n";
  write_file(path("all.csv"), text);
  REQUIRE(mpm({"convert", path("all.csv"), path("all.mcap"), "--config", path("small.yaml")}) == 0);

  // From minute 10 until before 50, without 30 to 34: 40 minutes, less 5 and 5.
  const std::vector<std::string> choice = {"--from", "600",       "--until",
                                           "3000",   "--exclude", "1800/2100"};
  const auto chosen = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), choice.begin(), choice.end());
    REQUIRE(mpm(arguments) == 0);
  };
  for (const char* input : {"all.csv", "all.mcap"}) {
    CAPTURE(input);
    chosen({"convert", path(input), path("some.csv"), "--time-zone", "seconds"});
    const std::vector<std::string> rows = lines_of(bench.text("some.csv"));
    REQUIRE(rows.size() == 31);
    CHECK(rows[1].rfind("600,", 0) == 0);
    CHECK(rows[15].rfind("1740,", 0) == 0);  // minutes 10 to 19 and 25 to 29
    CHECK(rows[16].rfind("2100,", 0) == 0);
    CHECK(rows[30].rfind("2940,", 0) == 0);
  }
  chosen({"info", path("all.csv"), "--json"});
  const auto csv = nlohmann::json::parse(bench.text("out"));
  CHECK(csv["rows"]["count"] == 30);
  CHECK(csv["gaps"]["count"] == 1);  // what is left out on purpose is none
  CHECK(csv["gaps"]["missing"] == 5);
  chosen({"info", path("all.mcap"), "--json"});
  const auto mcap = nlohmann::json::parse(bench.text("out"));
  CHECK(mcap["index"] == "intact");
  CHECK(mcap["units"][0]["samples"][0]["gaps"]["count"] == 1);
  CHECK(mcap["units"][0]["samples"][0]["gaps"]["missing"] == 5);

  for (const char* input : {"all.csv", "all.mcap"}) {
    CHECK(mpm({"convert", path(input), path("none.csv"), "--from", "5000"}) == 3);
    CHECK_FALSE(std::filesystem::exists(path("none.csv")));
    CHECK(bench.text("err").find("leave no row of it: it goes from 0 s to 3540 s") !=
          std::string::npos);
    CHECK(mpm({"info", path(input), "--from", "5000"}) == 3);
    CHECK(bench.text("err").find("leave nothing of it") != std::string::npos);
  }
}

TEST_CASE("what standard output does not take is a failure") {
  Bench bench;
  const auto path = [&](const char* name) { return bench.folder.file(name); };
  bag::McapFrameWriter a(path("a.mcap"), bench.unit, all_columns());
  for (const Frame& frame : any_frames(bench.unit, 30)) a.write(frame);
  a.finish();
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", path("a.mcap")},
        {"info", path("a.mcap"), "--json"},
        {"detect", "--config", path("small.yaml"), "--data", path("a.mcap"), "--json"},
        {"convert", path("a.mcap"), "-"},
        {"--version"}}) {
    CAPTURE(arguments);
    std::vector<std::string> all = arguments;
    all.insert(all.begin(), "mpm");
    CHECK(run(all, "/dev/full", path("err")) == 2);
    CHECK(bench.text("err").find("standard output") != std::string::npos);
  }
}

TEST_CASE("mpm recover never writes over the file that it mends") {
  Bench bench;
  const std::string file = bench.folder.file("torn.mcap");
  bag::McapFrameWriter writer(file, bench.unit, all_columns());
  for (const Frame& frame : any_frames(bench.unit, 30)) writer.write(frame);
  writer.finish();
  const std::string torn = read_file(file).substr(0, read_file(file).size() - 50);
  write_file(file, torn);
  std::filesystem::create_symlink(file, bench.folder.file("link.mcap"));
  std::filesystem::create_hard_link(file, bench.folder.file("twin.mcap"));
  const std::string other_way =
      bench.folder.file("../") +
      std::filesystem::path(bench.folder.file("x")).parent_path().filename().string() +
      "/torn.mcap";
  for (const std::string& output :
       {file, bench.folder.file("link.mcap"), bench.folder.file("twin.mcap"), other_way}) {
    CAPTURE(output);
    CHECK(run({"mpm", "recover", file, "--output", output}, bench.folder.file("out"),
              bench.folder.file("err")) == 3);
    CHECK(bench.text("err") == output + ": error: is the file that is read\n");
    CHECK(read_file(file) == torn);
  }
}

}  // namespace
}  // namespace mpm::test
