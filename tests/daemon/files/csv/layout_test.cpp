#include "daemon/files/csv/layout.hpp"

#include <catch2/catch.hpp>

#include "config/load_unit.hpp"

using namespace mpm;
using namespace mpm::files;

namespace {

std::vector<Cell> cells(const std::vector<std::string_view>& names) {
  std::vector<Cell> header;
  for (const std::string_view name : names) header.push_back({name, 1});
  return header;
}

}  // namespace

TEST_CASE("A wide header tells values from what qualifies them") {
  const auto layout = find_layout(cells({"Date", "Time", "a", "a.Quality", "b", "Status", "c",
                                         "c (Quality)", "c_Q", "d.quality", "", "Status.1"}),
                                  nullptr);
  REQUIRE(layout);
  CHECK_FALSE(layout->is_long);
  CHECK(layout->time.time == 0);
  CHECK(layout->time.clock == std::size_t{1});
  CHECK(layout->values == std::vector<std::size_t>{2, 4, 6});
  std::vector<std::pair<std::size_t, std::size_t>> qualities;
  for (const QualityColumn& column : layout->qualities)
    qualities.emplace_back(column.cell, column.value);
  CHECK(qualities ==
        std::vector<std::pair<std::size_t, std::size_t>>{{3, 2}, {5, 4}, {7, 6}, {8, 6}, {11, 6}});
  CHECK(layout->qualities[0].sure);
  CHECK_FALSE(layout->qualities[1].sure);
  CHECK(layout->orphans == std::vector<std::string>{"d.quality"});
  CHECK(layout->without_name == 1);
}

TEST_CASE("What the unit file names is a signal, whatever it is called") {
  const auto loaded = config::load_unit_text(
      "unit: t\nsample_time: 1\nsignals: {mv: P, cv: P_Q, aux: Status}\n"
      "model: {channels: [{cv: P_Q, mv: P, gain: 1}]}\n",
      "u.yaml");
  REQUIRE(loaded.ok());
  const TagTable tags(loaded.config);
  const std::vector<Cell> header = cells({"time", "P", "P_Q", "Status"});
  CHECK(find_layout(header, &tags)->values == std::vector<std::size_t>{1, 2, 3});
  CHECK(find_layout(header, nullptr)->values == std::vector<std::size_t>{1});
}

TEST_CASE("A long header has a tag, a time and a value") {
  const auto layout = find_layout(
      cells({"NAME", "TS", "VALUE", "QualityDetail", "Quality", "Questionable"}), nullptr);
  REQUIRE(layout);
  CHECK(layout->is_long);
  CHECK(layout->tag == 0);
  CHECK(layout->time.time == 1);
  CHECK(layout->value == 2);
  REQUIRE(layout->qualities.size() == 2);  // one code, and the flag
  CHECK(layout->qualities[0].cell == 5);
  CHECK(layout->qualities[1].cell == 4);
}

TEST_CASE("A header without a time is none") {
  CHECK_FALSE(find_layout(cells({"u1", "u2", "y1"}), nullptr));
  CHECK_FALSE(find_layout(cells({"u1", "t"}), nullptr));
  CHECK(find_layout(cells({"t", "u1"}), nullptr)->time.time == 0);
  CHECK(find_layout(cells({"u1", "Timestamp"}), nullptr)->time.time == 1);
}
