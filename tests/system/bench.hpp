#pragma once

#include <random>
#include <string>
#include <vector>

#include "daemon/bus/output_readers.hpp"
#include "idl/unit_publisher.hpp"
#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {

/// A unit file with two MVs and one CV, first-order channels of gains 2 and 1.
[[nodiscard]] std::string unit_yaml(const std::string& unit);

/// The plant of `unit_yaml`, driven by independent random binary moves, in the open.
class Plant {
 public:
  /// `first_gain`: of u1 -> y1; 2 is what the model says.
  explicit Plant(double first_gain) : first_gain_(first_gain), frame_(SignalCounts{2, 0, 1, 0}) {}
  [[nodiscard]] const Frame& next();

 private:
  double first_gain_;
  Frame frame_;
  std::mt19937_64 random_{1};
  double states_[2] = {0.0, 0.0};
  double moves_[2] = {0.0, 0.0};
};

/// What a test needs around one mpmd: its files, its own corner of the network, the control
/// system's side and an observer.
class Bench {
 public:
  /// `options`: more arguments for mpmd.
  explicit Bench(const std::string& test, const std::vector<std::string>& options = {},
                 const std::vector<std::string>& environment = {});

  [[nodiscard]] idl::UnitPublisher publisher(idl::WriterPace pace, const std::string& unit = "toy");
  /// Publishes that many frames of `plant`; the daemon must be there.
  void publish(const idl::UnitPublisher& publisher, Plant& plant, int frames);
  /// Collects outputs until `done(outputs)`; false after 20 s.
  template <class Done>
  [[nodiscard]] bool observe(Done&& done) {
    return idl::eventually(
        [&] {
          for (const bus::Output& output : readers.take()) outputs.push_back(output);
          return done();
        },
        std::chrono::seconds(20));
  }
  /// The last health of `unit` seen; empty if none.
  [[nodiscard]] report::HealthRecord health(const std::string& unit = "toy") const;
  /// All records of one type seen.
  template <class Record>
  [[nodiscard]] std::vector<Record> seen() const {
    std::vector<Record> records;
    for (const bus::Output& output : outputs)
      if (const auto* record = std::get_if<Record>(&output)) records.push_back(*record);
    return records;
  }
  [[nodiscard]] std::vector<std::string> watch(const std::vector<std::string>& options) const;

  TemporaryFolder folder;
  idl::DomainOptions options;
  Process daemon;
  idl::Participant participant;
  bus::OutputReaders readers;
  std::vector<bus::Output> outputs;

 private:
  [[nodiscard]] std::vector<std::string> daemon_arguments(const std::vector<std::string>& more);
};

}  // namespace mpm::test
