#include "daemon/files/csv/csv_reader.hpp"

#include <memory>
#include <sstream>

#include "daemon/files/csv/step_table.hpp"
#include "daemon/files/read_recording.hpp"
#include "tests/fuzz/small_unit.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {

void csv(std::string_view bytes) {
  static const files::TimeStyle berlin{std::make_shared<files::TimeZone>("Europe/Berlin"), nullptr};
  const auto open = [&](const files::TimeStyle& times, files::Purpose purpose) {
    return std::make_unique<files::CsvReader>(
        std::make_unique<std::istringstream>(std::string(bytes)), "d.csv", small_unit(), times,
        purpose);
  };
  for (const files::Purpose purpose : {files::Purpose::kJudge, files::Purpose::kKeep})
    tolerate([&] {
      const auto reader = open(berlin, purpose);
      Frame frame;
      std::size_t frames = 0;
      while (reader->next(frame)) ++frames;
      require(frames <= bytes.size(), "more rows than there are bytes");
    });
  tolerate([&] {
    const auto reader = open({}, files::Purpose::kJudge);
    static_cast<void>(files::read_recording(*reader, small_unit(), "d.csv"));
  });
  tolerate([&] { static_cast<void>(files::read_step_table(as_file(bytes), small_unit())); });
}

}  // namespace mpm::fuzz
