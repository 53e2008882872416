#include "tests/fuzz/small_unit.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "config/load_unit.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSmallUnit = R"(unit: small
sample_time: 1
signals:
  mv: [{tag: u1, low: -0.9, high: 0.9}, u2]
  dv: [{tag: d1}]
  cv: [{tag: y1, setpoint: s1, prediction: p1}, {tag: y2, setpoint: s2}]
  aux: [{tag: ambient}]
  raw: [{tag: weight}]
  calc: {s2: weight / 2}
model:
  channels:
    - {cv: y1, mv: u1, gain: 2, time_constants: [6], dead_time: 2}
    - {cv: y1, mv: u2, gain: -1, time_constants: [4], dead_time: 1}
    - {cv: y1, mv: d1, numerator: [0.1], denominator: [1, -0.9], delay_samples: 3}
    - {cv: y2, mv: u1, gain: 0.5, time_constants: [5]}
monitor: {memory: 200, fast_memory: 100, fir_lags: 4, residual_order: 2, tail: 4, first_lag: -3,
          last_lag: 6, controlling_lags: 4}
alarms: {on_delay: 4, off_delay: 15, realarm: 200, controller: {off_delay: 40}}
)";

struct OwnFolder {
  OwnFolder() {
    std::string name =
        (fs::is_directory("/dev/shm") ? "/dev/shm" : "/tmp") + std::string("/mpm-fuzz-XXXXXX");
    require(mkdtemp(name.data()) != nullptr, "no folder to work in");
    path = name;
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  ~OwnFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  std::string path;
};

}  // namespace

const config::UnitConfig& small_unit() {
  static const config::UnitConfig unit = [] {
    config::LoadResult loaded = config::load_unit_text(kSmallUnit, "small.yaml");
    require(loaded.ok(), "the unit of the fuzz targets is none");
    return loaded.config;
  }();
  return unit;
}

std::string as_file(std::string_view bytes) {
  static const int file = memfd_create("input", 0);
  require(ftruncate(file, 0) == 0 &&
              pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
          "no memory for a file");
  return "/proc/self/fd/" + std::to_string(file);
}

const std::string& folder() {
  static const OwnFolder own;
  return own.path;
}

}  // namespace mpm::fuzz
