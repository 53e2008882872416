#include <catch2/catch.hpp>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <set>
#include <thread>

#include "daemon/keys/key_folder.hpp"
#include "idl/log.hpp"
#include "tests/idl/bound_addresses.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test::security_test {
namespace {

namespace fs = std::filesystem;
using keys::Identity;
using keys::Role;
using keys::Validity;

constexpr std::time_t kDay = 86400;
constexpr std::chrono::seconds kPatience{60};
constexpr std::chrono::milliseconds kMoment{100};

/// A monitor on a secured bus, and whoever wants to take part.
struct SecuredBus {
  /// `days`: that the keys are valid for.
  explicit SecuredBus(const std::string& test, int days = 100) : options(idl::test_domain(test)) {
    idl::set_log_handler({});  // it tells of each stranger once a second
    (void)keys::make_keys(folder.file("keys"), std::nullopt, days, std::time(nullptr));
    write_file(folder.file("toy.yaml"),
               unit_yaml("toy") + "dds: {security: " + folder.file("keys") + "}\n");
    monitor.emplace(on_bus({"mpmd", "--config", folder.file("toy.yaml")}), folder.file("mpmd.out"),
                    folder.file("mpmd.err"));
  }
  [[nodiscard]] std::vector<std::string> on_bus(std::vector<std::string> arguments) const {
    for (const std::string& word : {std::string("--domain"), std::to_string(options.domain),
                                    std::string("--partition"), options.partition})
      arguments.push_back(word);
    return arguments;
  }
  /// Options of a participant with the keys of `role` in `keys`; no keys: empty.
  [[nodiscard]] idl::DomainOptions with(const std::string& keys, const std::string& role) const {
    idl::DomainOptions given = options;
    given.security = keys;
    given.role = role;
    return given;
  }
  [[nodiscard]] idl::DomainOptions as(const std::string& role) const {
    return with(folder.file("keys"), role);
  }
  [[nodiscard]] static UnitLayout layout() {
    UnitLayout layout;
    layout.unit = "toy";
    layout[SignalKind::kMv].tags = {"u1", "u2"};
    layout[SignalKind::kCv].tags = {"y1"};
    return layout;
  }

  TemporaryFolder folder;
  idl::DomainOptions options;
  std::optional<Process> monitor;
};

/// Reads what monitors say and writes what they read, as far as it is let.
struct Intruder {
  explicit Intruder(const idl::DomainOptions& options)
      : participant(options),
        health(participant, idl::kHealthTopic, idl::health_qos()),
        mv(participant, "mpm/mv", idl::sample_writer_qos(idl::WriterPace::kRealTime)) {}
  /// A monitor that takes this counts a sample of a unit that it does not know.
  void write() const {
    mpm_Sample sample{};
    std::string unit = "strange";
    sample.unit = unit.data();
    CHECK(mv.write(sample));
  }
  void check_kept_out() {
    CHECK(health.matched_writers() == 0);
    CHECK(mv.matched_readers() == 0);
    CHECK(health.take([](const mpm_Health&) {}) == 0);
  }
  idl::Participant participant;
  idl::Reader<mpm_Health> health;
  idl::Writer<mpm_Sample> mv;
};

/// Who belongs there, and comes after the intruders: what he is told they would have been told.
struct Insiders {
  explicit Insiders(const SecuredBus& bus)
      : viewing(bus.as("viewer")),
        readers(viewing),
        playing(bus.as("gateway")),
        gateway(playing, SecuredBus::layout(), idl::WriterPace::kLossless) {}
  /// Publishes more frames, of which the monitor takes each; what it says of itself in the end.
  std::string check_served(std::uint64_t frames) {
    REQUIRE(gateway.wait_for_readers(kPatience));
    for (std::uint64_t i = 0; i < frames; ++i) REQUIRE(gateway.publish(plant.next()));
    HealthRecord health;
    frames = taken += frames;
    CHECK(idl::eventually(
        [&] {
          for (const idl::Output& output : readers.take())
            if (const auto* said = std::get_if<HealthRecord>(&output)) health = *said;
          return health.frames >= frames;
        },
        kPatience));
    CHECK(health.frames == frames);
    CHECK(health.unknown_unit == 0);
    return health.detail;
  }
  idl::Participant viewing;
  idl::OutputReaders readers;
  idl::Participant playing;
  idl::UnitPublisher gateway;
  Plant plant{2.0};
  std::uint64_t taken = 0;
};

TEST_CASE("who has no keys, or a stranger's, neither reads nor writes on a secured bus") {
  SecuredBus bus("secured");
  (void)keys::make_keys(bus.folder.file("rogue"), std::nullopt, 30, std::time(nullptr));
  // A certificate that expires before anybody is met; permissions and governance are genuine.
  const fs::path authority = fs::path(bus.folder.file("keys")) / keys::kAuthorityFolder;
  const Identity ours = Identity::read(read_file(authority / keys::kCertificateFile),
                                       read_file(authority / keys::kKeyFile));
  bus.monitor.reset();  // nobody is there while its certificate is valid
  Intruder outsider(bus.with("", "")), rogue(bus.with(bus.folder.file("rogue"), "gateway"));
  fs::create_directory(bus.folder.file("brief"));
  const std::time_t now = std::time(nullptr);
  const Validity brief{now - kDay, now + 5};
  keys::write_participant(fs::path(bus.folder.file("brief")) / "gateway",
                          ours.issue("gateway", brief), ours,
                          keys::permissions_xml(keys::permissions_of(Role::kGateway), "CN=gateway",
                                                {now - kDay, now + kDay}));
  Intruder expired(bus.with(bus.folder.file("brief"), "gateway"));
  while (std::time(nullptr) <= brief.until) std::this_thread::sleep_for(kMoment);

  bus.monitor.emplace(bus.on_bus({"mpmd", "--config", bus.folder.file("toy.yaml")}),
                      bus.folder.file("mpmd.out"), bus.folder.file("mpmd.err"));
  Insiders insiders(bus);
  (void)insiders.check_served(50);
  for (const Intruder* intruder : {&outsider, &rogue, &expired}) intruder->write();
  (void)insiders.check_served(50);
  for (Intruder* intruder : {&outsider, &rogue, &expired}) intruder->check_kept_out();
  // Nor is it let begin.
  CHECK_THROWS(idl::Participant(bus.with(bus.folder.file("brief"), "gateway")));
}

TEST_CASE("each role does what it may, and nothing else") {
  SecuredBus bus("permissions");
  const auto writes = [&](const char* role, const char* topic) {
    const idl::Participant participant(bus.as(role));
    try {
      const idl::Writer<mpm_Sample> writer(participant, topic,
                                           idl::sample_writer_qos(idl::WriterPace::kRealTime));
      return true;
    } catch (const std::runtime_error& error) {
      CHECK_THAT(error.what(), Catch::Contains("Not Allowed By Security"));
      return false;
    }
  };
  CHECK(writes("gateway", "mpm/mv"));
  for (const char* topic :
       {"mpm/mv", "mpm/cv", "mpm/dv", "mpm/prediction", "mpm/setpoint", "mpm/raw", "mpm/layout"})
    for (const char* role : {"monitor", "viewer", "operator"}) {
      CAPTURE(role, topic);
      CHECK_FALSE(writes(role, topic));
    }
  for (const char* topic : {"mpm/alarm", "mpm/health", "mpm/command_reply"})
    for (const char* role : {"gateway", "viewer", "operator"}) {
      CAPTURE(role, topic);
      CHECK_FALSE(writes(role, topic));
    }
  CHECK_FALSE(writes("viewer", "mpm/command"));
  CHECK_FALSE(writes("gateway", "mpm/command"));
  const idl::Participant gateway(bus.as("gateway"));
  CHECK_THROWS_WITH(idl::Reader<mpm_Alarm>(gateway, idl::kAlarmTopic, idl::health_qos()),
                    Catch::Contains("Not Allowed By Security"));
  // Another's permissions, signed as they should be, are of no use to whom they do not name.
  fs::create_directory(bus.folder.file("mixed"));
  fs::copy(bus.folder.file("keys") + "/viewer", bus.folder.file("mixed") + "/viewer");
  fs::copy_file(bus.folder.file("keys") + "/gateway/" + keys::kPermissionsFile,
                bus.folder.file("mixed") + "/viewer/" + keys::kPermissionsFile,
                fs::copy_options::overwrite_existing);
  CHECK_THROWS(idl::Participant(bus.with(bus.folder.file("mixed"), "viewer")));

  Insiders insiders(bus);
  (void)insiders.check_served(50);
}

TEST_CASE("permissions that somebody gave himself open nothing") {
  SecuredBus bus("self-granted");
  // A genuine certificate, with permissions that an authority of its own has signed: the process
  // that has them believes them.
  const fs::path authority = fs::path(bus.folder.file("keys")) / keys::kAuthorityFolder;
  const Identity ours = Identity::read(read_file(authority / keys::kCertificateFile),
                                       read_file(authority / keys::kKeyFile));
  const std::time_t now = std::time(nullptr);
  const Validity validity{now - kDay, now + kDay};
  const Identity own = Identity::authority("mpm bus authority", validity);
  fs::create_directory(bus.folder.file("forged"));
  const fs::path forged = fs::path(bus.folder.file("forged")) / "viewer";
  keys::write_participant(forged, ours.issue("guest", validity), own,
                          keys::permissions_xml({{"mpm/*"}, {"mpm/*"}}, "CN=guest", validity));
  // Who he is is vouched for by ours, what he may do by his own.
  fs::rename(forged / keys::kAuthorityFile, forged / "own.pem");
  write_file(forged / keys::kAuthorityFile, ours.certificate_pem());
  std::string xml = idl::domain_xml(bus.with(bus.folder.file("forged"), "viewer"));
  const std::string element = "<PermissionsCA>file:";
  const std::size_t at = xml.find("ca.pem", xml.find(element));
  xml.replace(at, 6, "own.pem");
  const dds_domainid_t id = 200;
  const idl::Entity domain(dds_create_domain(id, xml.c_str()), "domain");
  const idl::Entity participant(dds_create_participant(id, nullptr, nullptr), "participant");
  const idl::Entity topic(
      dds_create_topic(participant.get(), &mpm_Sample_desc, "mpm/mv", nullptr, nullptr), "topic");
  const idl::Qos qos = idl::sample_writer_qos(idl::WriterPace::kRealTime);
  const idl::Entity writer(dds_create_writer(participant.get(), topic.get(), qos.get(), nullptr),
                           "writer");
  const idl::Entity said(
      dds_create_topic(participant.get(), &mpm_Health_desc, idl::kHealthTopic, nullptr, nullptr),
      "topic");
  const idl::Qos wanted = idl::health_qos();
  const idl::Entity reader(dds_create_reader(participant.get(), said.get(), wanted.get(), nullptr),
                           "reader");

  Insiders insiders(bus);
  (void)insiders.check_served(50);
  dds_publication_matched_status_t status{};
  REQUIRE(dds_get_publication_matched_status(writer.get(), &status) == DDS_RETCODE_OK);
  CHECK(status.total_count == 0);
  dds_subscription_matched_status_t heard{};
  REQUIRE(dds_get_subscription_matched_status(reader.get(), &heard) == DDS_RETCODE_OK);
  CHECK(heard.total_count == 0);
}

TEST_CASE("every program takes part on a secured bus with the keys of its role") {
  SecuredBus bus("programs");
  const std::string out = bus.folder.file("out"), err = bus.folder.file("err");
  const std::string keys = bus.folder.file("keys"), unit = bus.folder.file("toy.yaml");
  write_file(bus.folder.file("sim.yaml"), read_file(MPM_SOURCE_DIR "/config/units/example.yaml"));
  const auto says = [&](const std::vector<std::string>& arguments) {
    const std::optional<int> code = run(bus.on_bus(arguments), out, err);
    INFO(read_file(err));
    REQUIRE(code);
    return *code;
  };
  const idl::Participant viewing(bus.as("viewer"));
  idl::OutputReaders readers(viewing);
  const auto frames = [&] {
    std::uint64_t count = 0;
    for (const idl::Output& output : readers.take())
      if (const auto* health = std::get_if<HealthRecord>(&output)) count = health->frames;
    return count;
  };
  REQUIRE(idl::eventually(
      [&] {
        for (const idl::Output& output : readers.take())
          if (std::holds_alternative<HealthRecord>(output)) return true;
        return false;
      },
      kPatience));

  // By --security and by the unit file alike.
  Process recorder(
      bus.on_bus({"mpm", "record", "--security", keys, "--output", bus.folder.file("run.mcap")}),
      bus.folder.file("record.out"), bus.folder.file("record.err"));
  Process watch(bus.on_bus({"mpm", "watch", "--json", "--config", unit}),
                bus.folder.file("watch.out"), bus.folder.file("watch.err"));
  CHECK(idl::eventually(
      [&] { return read_file(bus.folder.file("watch.out")).find("\"toy\"") != std::string::npos; },
      kPatience));
  std::string lines = "time,u1,u2,y1\n";
  for (int i = 1; i <= 50; ++i) lines += std::to_string(i) + ",1,2,3\n";
  write_file(bus.folder.file("lines.csv"), lines);
  CHECK(run(bus.on_bus({"mpm", "publish", "--config", unit, "--readers", "2"}), out, err,
            bus.folder.file("lines.csv")) == 0);
  INFO(read_file(err));
  CHECK(idl::eventually([&] { return frames() >= 50; }, kPatience));
  recorder.send(SIGTERM);
  CHECK(recorder.wait(kPatience) == 0);
  CHECK(says({"mpm", "replay", bus.folder.file("run.mcap"), "--security", keys, "--rate", "0"}) ==
        0);
  CHECK(read_file(err).find("reader") == std::string::npos);
  CHECK(says({"mpm", "topics", "--security", keys}) == 0);
  CHECK(read_file(out).find("mpm/health") != std::string::npos);
  CHECK(says({"mpm", "status", "--config", unit}) < 2);
  CHECK(says({"mpm", "alarms", "--config", unit}) == 0);
  write_file(bus.folder.file("token"), "0123456789abcdef");
  fs::permissions(bus.folder.file("token"), fs::perms::owner_read);
  // The monitor has no token, and says so: it was heard and answered.
  CHECK(says({"mpm", "ack", "--config", unit, "--token-file", bus.folder.file("token")}) == 1);
  CHECK(read_file(out).find("without --token-file") != std::string::npos);
  watch.send(SIGTERM);
  CHECK(watch.wait(kPatience) == 0);
}

TEST_CASE("the shipped client takes part with the shipped settings") {
  SecuredBus bus("client");
  std::string xml = read_file(MPM_SOURCE_DIR "/tests/hmi/secure.xml");
  const std::size_t at = xml.find("<Discovery>") + std::string("<Discovery>").size();
  xml.insert(at, "<Tag>" + bus.options.partition + "</Tag>");
  write_file(bus.folder.file("secure.xml"), xml);
  const Process client({MPM_HMI_DIR "/hmi_alarms_c", std::to_string(bus.options.domain), "60"},
                       bus.folder.file("out"), bus.folder.file("err"),
                       {"CYCLONEDDS_URI=file://" + bus.folder.file("secure.xml"),
                        "MPM_KEYS=" + bus.folder.file("keys") + "/viewer"});
  CHECK(idl::eventually(
      [&] { return read_file(bus.folder.file("out")).find("health toy") != std::string::npos; },
      kPatience));
  INFO(read_file(bus.folder.file("err")));
}

TEST_CASE("a monitor tells a month before that its keys expire") {
  SecuredBus bus("expiry", 29);
  Insiders insiders(bus);
  CHECK_THAT(insiders.check_served(50), Catch::Contains("the keys of this monitor expire 20"));
}

TEST_CASE("keys that are missing are named, where the unit file asks for them") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  const std::string unit = folder.file("toy.yaml"), keys = folder.file("none");
  const std::string text = unit_yaml("toy");
  write_file(unit, text + "dds: {security: " + keys + "}\n");
  const std::string line = std::to_string(lines_of(text).size() + 1);
  const std::string finding = unit + ":" + line + ":17: error: dds.security: " + keys +
                              "/monitor/ca.pem: No such file or directory\n";
  CHECK(run({"mpmd", "--config", unit, "--check"}, out, err) == 1);
  CHECK_THAT(read_file(out), Catch::StartsWith(finding));
  CHECK(run({"mpmd", "--config", unit}, out, err) == 3);
  CHECK_THAT(read_file(err), Catch::StartsWith(finding));
  CHECK(run({"mpmd", "--config", unit, "--security", folder.file("other"), "--check"}, out, err) ==
        1);
  CHECK_THAT(read_file(out),
             Catch::StartsWith("--security: error: " + folder.file("other") + "/monitor/ca.pem: "));
  // What is written as a unit file, as extended models are, has to be read again from anywhere.
  const std::string relative = fs::relative(keys).string();
  CHECK(run({"mpmd", "--config", unit, "--security", relative, "--print-config"}, out, err) == 0);
  CHECK_THAT(read_file(out), Catch::Contains("security: \"" + keys + "\""));
  CHECK(run({"mpmd", "--config", unit, "--security", "", "--check"}, out, err) == 0);
  // Who has no keys may look at the settings all the same.
  CHECK(run({"mpmd", "--config", unit, "--print-config"}, out, err) == 0);
  CHECK(run({"mpm", "status", "--config", unit}, out, err) == 3);  // UNKNOWN
  CHECK_THAT(read_file(out), Catch::Contains("keys of the viewer: " + keys + "/viewer/ca.pem: "));
}

TEST_CASE("a monitor has sockets on its interface only, and no secret of its keys in its log") {
  SecuredBus bus("sockets");
  bus.monitor.reset();
  bus.monitor.emplace(
      bus.on_bus({"mpmd", "--config", bus.folder.file("toy.yaml"), "--log-level", "trace"}),
      bus.folder.file("mpmd.out"), bus.folder.file("mpmd.err"));
  Insiders insiders(bus);
  (void)insiders.check_served(50);
  const std::string process = std::to_string(bus.monitor->pid());
  CHECK(bound_addresses(process) == std::set<std::string>{kLoopbackAddress});
  const std::string told = read_file(bus.folder.file("mpmd.out")) +
                           read_file(bus.folder.file("mpmd.err")) +
                           read_file("/proc/" + process + "/cmdline");
  for (const std::string& line : lines_of(read_file(bus.folder.file("keys") + "/monitor/key.pem")))
    CHECK(told.find(line) == std::string::npos);
}

}  // namespace
}  // namespace mpm::test::security_test
