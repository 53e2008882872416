// alarms DOMAIN SECONDS: as alarms.c, in C++. Cyclone 0.10 of Debian 12 has a C interface only; two
// small classes make entities and loans safe.
#include <dds/dds.h>

#include <array>
#include <iostream>
#include <stdexcept>
#include <string>

#include "entity.hpp"
#include "mpm.h"

namespace {

/// Reads a topic that keeps the last word of each key for late joiners.
template <class Sample>
class Reader {
 public:
  Reader(const Entity& participant, const dds_topic_descriptor_t& type, const std::string& name)
      : topic_(dds_create_topic(participant.get(), &type, name.c_str(), nullptr, nullptr), name),
        reader_(create(participant, topic_), name) {}

  /// `on_sample(const Sample&, bool valid)`; where it is not valid only the key is there.
  template <class Callback>
  void take(Callback&& on_sample) {
    std::array<void*, 64> samples{};  // null: lend them
    std::array<dds_sample_info_t, 64> infos;
    const dds_return_t count =
        dds_take(reader_.get(), samples.data(), infos.data(), samples.size(), samples.size());
    for (std::size_t i = 0; static_cast<dds_return_t>(i) < count; ++i)
      on_sample(*static_cast<const Sample*>(samples[i]), infos[i].valid_data);
    if (count > 0) dds_return_loan(reader_.get(), samples.data(), count);
  }

 private:
  static dds_entity_t create(const Entity& participant, const Entity& topic) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
    const dds_entity_t reader = dds_create_reader(participant.get(), topic.get(), qos, nullptr);
    dds_delete_qos(qos);
    return reader;
  }

  Entity topic_;
  Entity reader_;
};

void run(dds_domainid_t domain, int seconds) {
  const Entity participant(dds_create_participant(domain, nullptr, nullptr), "participant");
  Reader<mpm_Alarm> alarms(participant, mpm_Alarm_desc, "mpm/alarm");
  Reader<mpm_Health> health(participant, mpm_Health_desc, "mpm/health");
  const dds_time_t end = dds_time() + DDS_SECS(seconds);
  while (dds_time() < end) {
    alarms.take([](const mpm_Alarm& alarm, bool valid) {
      std::cout << "alarm " << alarm.unit << ' ' << alarm.mv << ' ' << alarm.cv << ' '
                << (valid ? alarm.state : "unknown") << std::endl;
    });
    health.take([](const mpm_Health& word, bool valid) {
      std::cout << "health " << word.unit << ' ' << (valid ? word.state : "gone") << std::endl;
    });
    dds_sleepfor(DDS_MSECS(50));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: alarms DOMAIN SECONDS\n";
    return 3;
  }
  try {
    run(static_cast<dds_domainid_t>(std::stoul(argv[1])), std::stoi(argv[2]));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
