#include "daemon/report/health.hpp"

namespace mpm::report {

nlohmann::ordered_json to_json(const HealthRecord& record) {
  return {{"record", "health"},
          {"unit", record.unit},
          {"interval", record.interval},
          {"time_ns", record.source_time_ns},
          {"state", record.state},
          {"detail", record.detail},
          {"frames", record.frames},
          {"used", record.used},
          {"missing", record.missing},
          {"incomplete", record.incomplete},
          {"late", record.late},
          {"repeated", record.repeated},
          {"out_of_order", record.out_of_order},
          {"bad_values", record.bad_values},
          {"wrong_length", record.wrong_length},
          {"unknown_unit", record.unknown_unit},
          {"restarts", record.restarts},
          {"undetermined", record.undetermined},
          {"matching", record.matching},
          {"mismatching", record.mismatching},
          {"active_alarms", record.active_alarms}};
}

}  // namespace mpm::report
