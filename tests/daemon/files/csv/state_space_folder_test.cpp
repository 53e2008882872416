#include "daemon/files/csv/state_space_folder.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "config/finding.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

/// A unit of one input and two CVs, and a folder with its three-state model.
struct Bench {
  TemporaryFolder folder;
  config::UnitConfig unit;

  Bench() {
    unit.unit = "small";
    unit.sample_time_s = 10.0;
    unit.mv = {{"u", "", ""}};
    unit.cv.resize(2);
    unit.cv[0].tag = "y";
    unit.cv[1].tag = "z";
    put("A", "0.5,0,0\n0,0.6,0\n0,0,0.7\n");
    put("B", "u\n1\n2\n3\n");
    put("C", "y;1;2;3\nz;4;5;6,5\n");
    put("D", ",u\ny,0.1\nz,0.2\n");
  }
  void put(const std::string& name, const std::string& text) const {
    write_file(folder.file(name + ".csv"), text);
  }
  [[nodiscard]] StateSpaceSpec read() const {
    return files::read_state_space_folder(folder.file(""), unit);
  }
  /// What is said behind the name of the folder.
  [[nodiscard]] std::string refusal() const {
    try {
      static_cast<void>(read());
    } catch (const config::InputError& error) {
      return std::string(error.what()).substr(folder.file("").size());
    }
    return "read";
  }
};

}  // namespace

TEST_CASE("matrices are read with tags around them, in either dialect") {
  const Bench bench;
  const StateSpaceSpec system = bench.read();
  CHECK(system.a.diagonal() == Eigen::Vector3d(0.5, 0.6, 0.7));
  CHECK(system.b == Eigen::Vector3d(1, 2, 3));
  CHECK(system.c(1, 2) == 6.5);
  CHECK(system.d == Eigen::Vector2d(0.1, 0.2));
  CHECK(system.x0.size() == 0);
}

TEST_CASE("a matrix that does not fit is refused with its file") {
  const Bench bench;
  bench.put("D", "z,0.1\ny,0.2\n");
  CHECK(bench.refusal() == "D.csv:1:1: error: 'z' stands where the unit file has 'y'");
  bench.put("D", "0.1\n0.2\n0.3\n");
  CHECK(bench.refusal() == "D.csv: error: must be 2 x 1 (CVs x MVs and DVs), not 3 x 1");
  bench.put("D", "0.1\n0.2\n");
  bench.put("x0", "1,2\n");
  CHECK(bench.refusal() == "x0.csv: error: must be 3 numbers, one per state");
  bench.put("x0", "1,2,3\n");
  CHECK(bench.read().x0 == Eigen::Vector3d(1, 2, 3));
  bench.put("A", "# sample_time: 10\n0.5,0\n0\n");
  CHECK(bench.refusal() == "A.csv:3:1: error: this row has 1 number, the first one 2");
  bench.put("A", "");
  CHECK(bench.refusal() == "A.csv:1:1: error: holds nothing");
}

}  // namespace mpm::test
