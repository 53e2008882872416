#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/system/corner.hpp"

namespace mpm::test {
namespace {

TEST_CASE("lines on standard input become samples that the monitor judges as it would the file") {
  const Corner corner("publish");
  const std::string unit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";
  const auto file = [&](const char* name) { return corner.folder.file(name); };
  REQUIRE(run({"mpmsim", "--config", unit, "--scenario", "hidden_gain", "--seed", "5", "--samples",
               "600", "--csv", file("run.csv")},
              file("sim.out"), file("sim.err")) == 0);
  REQUIRE(run({"mpm", "detect", "--config", unit, "--data", file("run.csv"),
               "--journal-every-sample", file("expected.jsonl")},
              file("detect.out"), file("detect.err")) == 0);
  const std::string expected = read_file(file("expected.jsonl"));

  // The same once more as JSON, one object per line.
  const std::vector<std::string> rows = lines_of(read_file(file("run.csv")));
  std::string json;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::istringstream names(rows[0]), cells(rows[i]);
    json += "{";
    for (std::string name, cell; std::getline(names, name, ',') && std::getline(cells, cell, ',');)
      json += (json.back() == '{' ? "\"" : ",\"") + name + "\":" + cell;
    json += "}\n";
  }
  write_file(file("run.jsonl"), json);

  for (const char* input : {"run.csv", "run.jsonl"}) {
    CAPTURE(input);
    const std::string journal = file("live.jsonl");
    std::filesystem::remove(journal);
    Process monitor = corner.start({"mpmd", "--config", unit, "--journal-every-sample", journal});
    CHECK(corner.mpm({"publish", "--config", unit}, file(input)) == 0);
    CHECK(idl::eventually([&] { return read_file(journal).size() >= expected.size(); }, kPatience));
    const bool same = read_file(journal) == expected;
    CHECK(same);
    monitor.send(SIGTERM);
    CHECK(monitor.wait(kPatience) == 0);
  }
}

TEST_CASE("mpm publish names the line that is wrong, and stops or goes on") {
  const Corner corner("publish_bad");
  const std::string unit = corner.folder.file("toy.yaml"), input = corner.folder.file("lines");
  const auto publish = [&](const std::string& lines, const std::string& on_error) {
    write_file(input, lines);
    return corner.mpm({"publish", "--config", unit, "--wait-readers", "0", "--on-error", on_error},
                      input);
  };
  const std::string bad_csv = "time,u1,u2,y1\n0,1,2,3\n1,1,2x,3\n2,1,2,3\n";
  CHECK(publish(bad_csv, "stop") == 3);
  CHECK(corner.err() == "stdin:3:5: error: '2x' is no number; leave empty what is missing\n");
  CHECK(publish(bad_csv, "skip") == 0);
  CHECK(lines_of(corner.err()).back() == "mpm publish: 2 lines published, 1 skipped");
  CHECK(publish("{\"time\":0,\"u1\":1}\n{\"time\":1,\"u1\":}\n", "stop") == 3);
  CHECK(corner.err() == "stdin:2:16: error: is no JSON\n");
  CHECK(publish("{\"u1\":1}\n[]\n{\"time\":0,\"u1\":1,\"u1.quality\":\"bad\"}\n", "skip") == 0);
  CHECK(lines_of(corner.err()).size() == 3);
  CHECK(publish("time,u1\n0,1\n", "stop") == 3);
  CHECK(publish("", "stop") == 3);
}

TEST_CASE("no line of JSON ends mpm publish --on-error skip, and each is told with its place") {
  const Corner corner("publish_json");
  const std::string deep(100'000, '['), undeep(100'000, ']');
  write_file(corner.folder.file("lines"),
             "{\"time\":1,\"u1\":1e400}\n"
             "{\"time\":2, \"u1\" : \"x\"}\n"
             "{\"time\":3,\"u1\":1,\"u1.quality\":\"so so\"}\n"
             "{\"time\":4,\"u1\":" +
                 deep + undeep +
                 "}\n"
                 "{\"u2\":1,\"time\":\"now\"}\n"
                 "{\"time\":5,\"interval\":1.5}\n"
                 "{\"time\":6,\"u1\":2}\n");
  const auto publish = [&](const std::string& on_error) {
    return corner.mpm({"publish", "--config", corner.folder.file("toy.yaml"), "--wait-readers", "0",
                       "--on-error", on_error},
                      corner.folder.file("lines"));
  };
  CHECK(publish("stop") == 3);
  CHECK(corner.err() == "stdin:1:16: error: 'u1' is out of range\n");
  CHECK(publish("skip") == 0);
  const std::vector<std::string> said = lines_of(corner.err());
  REQUIRE(said.size() == 7);
  CHECK(said[1] == "stdin:2:19: error: 'u1': \"x\" is no number");
  CHECK(said[2].find("stdin:3:31: error: 'u1.quality': \"so so\" is no quality") == 0);
  CHECK(said[3] == "stdin:4:16: error: 'u1': [...] is no number");
  CHECK(said[4].find("stdin:5:16: error: \"time\": 'now'") == 0);
  CHECK(said[5] == "stdin:6:22: error: \"interval\": 1.5 is no interval number");
  CHECK(said[6] == "mpm publish: 1 line published, 6 skipped");
}

TEST_CASE("mpm publish that is stopped before its first line has done nothing wrong") {
  const Corner corner("publish_idle");
  const std::string pipe = corner.folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int silent = open(pipe.c_str(), O_RDWR);  // so that no end comes
  REQUIRE(silent >= 0);
  for (const std::string begun : {"", "{\"time\":1,"}) {
    Process publish(corner.on_bus({"mpm", "publish", "--config", corner.folder.file("toy.yaml")}),
                    corner.folder.file("out"), corner.folder.file("err"), {}, pipe);
    REQUIRE(write(silent, begun.data(), begun.size()) == static_cast<ssize_t>(begun.size()));
    REQUIRE(idl::eventually([&] { return blocks_interrupts(publish.pid()); }, kPatience));
    publish.send(SIGINT);
    CHECK(publish.wait(kPatience) == 0);
    INFO(corner.err());
    CHECK(corner.err().find("error") == std::string::npos);
  }
  close(silent);
}

TEST_CASE("mpm publish takes a CSV without predictions and says what becomes of them") {
  const Corner corner("publish_bare");
  const std::string unit = corner.folder.file("predicted.yaml");
  std::string text = unit_yaml("toy");
  const std::string cv = "{tag: y1, ";
  text.replace(text.find(cv), cv.size(), cv + "prediction: yhat1, ");
  write_file(unit, text);
  write_file(corner.folder.file("lines"), "time,u1,u2,y1\n0,1,2,3\n");
  CHECK(corner.mpm({"publish", "--config", unit, "--wait-readers", "0"},
                   corner.folder.file("lines")) == 0);
  CHECK(corner.err().find("model simulates instead") != std::string::npos);
  CHECK(lines_of(corner.err()).back() == "mpm publish: 1 line published");
}

}  // namespace
}  // namespace mpm::test
