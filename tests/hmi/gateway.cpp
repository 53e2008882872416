// gateway DOMAIN UNIT SAMPLES PERIOD_MS: as gateway.c, in C++: plays the control system of a unit
// with MVs u1, u2 and CV y1. A real gateway reads the values from the control system where this one
// makes them up.
#include <dds/dds.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "entity.hpp"
#include "mpm.h"

namespace {

/// Writes samples of one topic. It is reliable and never waits.
template <class Sample>
class Writer {
 public:
  Writer(const Entity& participant, const dds_topic_descriptor_t& type, const std::string& name,
         dds_durability_kind_t durability, int depth)
      : topic_(dds_create_topic(participant.get(), &type, name.c_str(), nullptr, nullptr), name),
        writer_(create(participant, topic_, durability, depth), name) {}

  void write(const Sample& sample) const {
    const dds_return_t result = dds_write(writer_.get(), &sample);
    if (result < 0) throw std::runtime_error(std::string("write: ") + dds_strretcode(result));
  }
  // What is written before a reader is known is lost to it, and the reader has to know the writer.
  void wait_for_reader() const {
    dds_publication_matched_status_t status{};
    for (int i = 0; i < 1000 && status.current_count == 0; ++i) {
      dds_get_publication_matched_status(writer_.get(), &status);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  void wait_until_taken() const { dds_wait_for_acks(writer_.get(), DDS_SECS(10)); }

 private:
  static dds_entity_t create(const Entity& participant, const Entity& topic,
                             dds_durability_kind_t durability, int depth) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(10));
    dds_qset_durability(qos, durability);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
    const dds_entity_t writer = dds_create_writer(participant.get(), topic.get(), qos, nullptr);
    dds_delete_qos(qos);
    return writer;
  }

  Entity topic_;
  Entity writer_;
};

/// One kind of signals of a unit: says once what they are, then their values of each interval.
class Signals {
 public:
  struct Signal {
    std::string tag, engineering_unit;
  };

  Signals(const Entity& participant, const Writer<mpm_Layout>& layouts, std::string unit,
          std::string kind, std::vector<Signal> signals)
      : unit_(std::move(unit)),
        kind_(std::move(kind)),
        signals_(std::move(signals)),
        writer_(participant, mpm_Sample_desc, "mpm/" + kind_, DDS_DURABILITY_VOLATILE, 256) {
    std::vector<char*> tags, engineering_units;
    for (Signal& signal : signals_) {
      tags.push_back(signal.tag.data());
      engineering_units.push_back(signal.engineering_unit.data());
    }
    const auto count = static_cast<std::uint32_t>(signals_.size());
    mpm_Layout layout{};
    layout.unit = unit_.data();
    layout.kind = kind_.data();
    layout.sample_time_s = 1.0;
    layout.tags = {count, count, tags.data(), false};
    layout.engineering_units = {count, count, engineering_units.data(), false};
    layouts.write(layout);
    writer_.wait_for_reader();
  }

  /// `time_ns`: of UTC since 1970. No qualities: all values are good.
  void write(std::int64_t interval, std::int64_t time_ns, std::vector<double> values) {
    const auto count = static_cast<std::uint32_t>(values.size());
    mpm_Sample sample{};
    sample.unit = unit_.data();
    sample.interval = interval;
    sample.source_time_ns = time_ns;
    sample.values = {count, count, values.data(), false};
    writer_.write(sample);
  }
  void wait_until_taken() const { writer_.wait_until_taken(); }

 private:
  std::string unit_, kind_;
  std::vector<Signal> signals_;
  Writer<mpm_Sample> writer_;
};

void run(dds_domainid_t domain, const std::string& unit, int samples,
         std::chrono::milliseconds period) {
  const Entity participant(dds_create_participant(domain, nullptr, nullptr), "participant");
  const Writer<mpm_Layout> layouts(participant, mpm_Layout_desc, "mpm/layout",
                                   DDS_DURABILITY_TRANSIENT_LOCAL, 1);
  Signals mv(participant, layouts, unit, "mv", {{"u1", "%"}, {"u2", "%"}});
  Signals cv(participant, layouts, unit, "cv", {{"y1", "degC"}});

  const double pole = std::exp(-1.0 / 5.0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-0.05, 0.05);
  std::array<double, 2> u{};
  double y = 0.0;
  for (std::int64_t interval = 1; interval <= samples; ++interval) {
    const double measured = y + noise(random);
    y = pole * y + (1.0 - pole) * (4.0 * u[0] + u[1]);  // the model says 2 where this says 4
    for (double& value : u)
      if (random() % 10 == 0) value = random() % 2 == 0 ? 1.0 : -1.0;
    const dds_time_t now = dds_time();
    mv.write(interval, now, {u[0], u[1]});
    cv.write(interval, now, {measured});
    std::this_thread::sleep_for(period);
  }
  mv.wait_until_taken();
  cv.wait_until_taken();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: gateway DOMAIN UNIT SAMPLES PERIOD_MS\n";
    return 3;
  }
  try {
    run(static_cast<dds_domainid_t>(std::stoul(argv[1])), argv[2], std::stoi(argv[3]),
        std::chrono::milliseconds(std::stoi(argv[4])));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
