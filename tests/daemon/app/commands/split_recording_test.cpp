#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "daemon/mcap/read/ordered_reader.hpp"
#include "daemon/mcap/write/writer.hpp"
#include "tests/daemon/bag/bench.hpp"

namespace mpm::test::split_recording_test {
namespace {

const std::string kShell = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";

/// Cuts a recording into files of so many messages each, with no regard for the intervals.
void split(const std::string& whole, const std::vector<std::string>& parts, std::size_t messages) {
  const auto source = mcap::open_messages(whole);
  mcap::Message message;
  bool more = source->next(message);
  for (const std::string& part : parts) {
    mcap::Writer writer(part);
    std::map<std::string, mcap::ChannelId> channels;
    for (std::size_t k = 0; more && (k < messages || part == parts.back()); ++k) {
      if (channels.count(message.channel->topic) == 0)
        channels[message.channel->topic] = writer.add_channel(
            writer.add_schema(message.schema->name, "omgidl", ""), message.channel->topic, "cdr");
      writer.write(channels[message.channel->topic], message.log_time_ns, message.publish_time_ns,
                   message.data);
      more = source->next(message);
    }
    writer.finish();
  }
}

struct Rotated : Bench {
  std::vector<std::string> parts;  // whose names are not in the order of time

  Rotated() {
    std::filesystem::create_directory(folder.file("parts"));
    for (const char* name : {"parts/c.mcap", "parts/a.mcap", "parts/b.mcap"})
      parts.push_back(folder.file(name));
    REQUIRE(run({"mpmsim", "--config", kShell, "--samples", "700", "--csv", folder.file("r.csv")},
                folder.file("out"), folder.file("err")) == 0);
    bag::ConvertOptions options;
    options.unit = config::load_unit(kShell).config;
    static_cast<void>(convert("r.csv", "whole.mcap", options));
    split(folder.file("whole.mcap"), parts, 1001);
  }
  std::string mpm(std::vector<std::string> arguments, int expected = 0) {
    arguments.insert(arguments.begin(), "mpm");
    REQUIRE(run(arguments, folder.file("out"), folder.file("err")) == expected);
    return text("out");
  }
  /// What detect says on its output and in the journal.
  std::string detect(std::vector<std::string> data) {
    std::filesystem::remove(folder.file("journal"));
    std::vector<std::string> arguments = {"detect", "--config", kShell, "--data"};
    arguments.insert(arguments.end(), data.begin(), data.end());
    arguments.insert(arguments.end(), {"--json", "--journal-every-sample", folder.file("journal")});
    const std::string said = mpm(arguments);
    return said + text("journal");
  }
};

TEST_CASE("A recording that was split is one recording to detect, convert and info") {
  Rotated bench;
  const std::string parts = bench.folder.file("parts");
  const std::string whole = bench.folder.file("whole.mcap");
  CHECK(bench.detect({parts}) == bench.detect({whole}));
  CHECK(bench.detect(bench.parts) == bench.detect({whole}));

  bench.mpm({"convert", whole, bench.folder.file("whole.csv")});
  bench.mpm({"convert", parts, bench.folder.file("parts.csv")});
  CHECK(bench.text("parts.csv") == bench.text("whole.csv"));

  auto one = nlohmann::json::parse(bench.mpm({"info", whole, "--json"}));
  auto many = nlohmann::json::parse(bench.mpm({"info", parts, "--json"}));
  CHECK(many["files"] == nlohmann::json(bench.parts));
  CHECK(many["index"] == "intact");
  CHECK(many["units"] == one["units"]);
  CHECK(many["messages"] == one["messages"]);
  CHECK(bench.mpm({"info", bench.parts[2], bench.parts[0], bench.parts[1]}).find(", 3 files") !=
        std::string::npos);

  // Files of both kinds are one history; what the first one has counts.
  CHECK(bench.detect({bench.folder.file("r.csv"), whole}) ==
        bench.detect({bench.folder.file("r.csv")}));

  // What cannot be one recording.
  bench.mpm({"info", whole, bench.folder.file("r.csv")}, 3);
  CHECK(bench.text("err").find("r.csv: error: is no MCAP file") != std::string::npos);
  std::filesystem::create_directory(bench.folder.file("empty"));
  bench.mpm({"detect", "--config", kShell, "--data", bench.folder.file("empty")}, 3);
  CHECK(bench.text("err").find("no *.mcap file in this folder") != std::string::npos);
}

TEST_CASE("Info names the torn one of several files") {
  Rotated bench;
  const std::string bytes = read_file(bench.parts[1]);
  write_file(bench.parts[1], bytes.substr(0, bytes.size() / 2));
  const auto json =
      nlohmann::json::parse(bench.mpm({"info", bench.folder.file("parts"), "--json"}));
  CHECK(json["whole"] == false);
  CHECK(json["problem"].get<std::string>().find(bench.parts[1] + ": byte ") == 0);
  CHECK(json["index"] == bench.parts[1] + ": the file has no end");
  bench.mpm({"detect", "--config", kShell, "--data", bench.folder.file("parts")}, 3);
  CHECK(bench.text("err").find(bench.parts[1]) != std::string::npos);
}

}  // namespace
}  // namespace mpm::test::split_recording_test
