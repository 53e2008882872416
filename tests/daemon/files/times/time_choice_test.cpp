#include "daemon/files/times/time_choice.hpp"

#include <catch2/catch.hpp>

#include "config/finding.hpp"

namespace mpm::files {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST_CASE("the first time is taken, the last no more, and what is excluded neither") {
  CHECK(TimeChoice().all());
  CHECK(TimeChoice().takes(0));
  const TimeChoice choice({"10", "100", {"20/30", "25/40"}});
  CHECK_FALSE(choice.all());
  for (const std::int64_t second : {10, 19, 40, 99}) CHECK(choice.takes(second * kSecond));
  for (const std::int64_t second : {9, 20, 25, 30, 39, 100})
    CHECK_FALSE(choice.takes(second * kSecond));
  // 2024-01-01 is day 19723 since 1970.
  const TimeStyle day_first{std::make_shared<TimeZone>("UTC"),
                            std::make_shared<TimeFormat>("%d/%m/%Y %H:%M")};
  const TimeChoice as_in_file({"01/02/2024 00:00", "", {}}, day_first);
  CHECK(as_in_file.takes(1'706'745'600'000'000'000));  // date -u -d 2024-02-01 +%s
  CHECK_FALSE(as_in_file.takes(1'706'745'599'000'000'000));
  // The thirteenth month is none: of either order, without anybody saying which.
  for (const char* first : {"28/2/2024 01:00", "2/28/2024 1:00:00 AM"}) {
    const TimeChoice either({first, "", {}}, {std::make_shared<TimeZone>("UTC"), nullptr});
    CHECK(either.takes(1'709'082'000'000'000'000));  // date -u -d '2024-02-28 1:00' +%s
    CHECK_FALSE(either.takes(1'709'081'999'000'000'000));
  }
  CHECK_THROWS_AS(
      TimeChoice({"4/3/2024 01:00", "", {}}, {std::make_shared<TimeZone>("UTC"), nullptr}),
      config::InputError);
  const TimeChoice dates({"2024-01-01T01:00:00+01:00", "", {}});
  CHECK(dates.takes(19723 * 86400 * kSecond));
  CHECK_FALSE(dates.takes(19723 * 86400 * kSecond - 1));
}

TEST_CASE("nonsense is refused by the name of the option") {
  const auto refusal = [](const TimeChoiceText& text) -> std::string {
    try {
      static_cast<void>(TimeChoice(text));
    } catch (const config::InputError& error) {
      return error.finding().file;
    }
    return "none";
  };
  CHECK(refusal({"soon", "", {}}) == "--from");
  CHECK(refusal({"", "2024-01-01T00:00:00", {}}) == "--until");  // of no zone
  CHECK(refusal({"5", "5", {}}) == "--until");
  CHECK(refusal({"", "", {"1/2", "3"}}) == "--exclude");
  CHECK(refusal({"", "", {"2/1"}}) == "--exclude");
  CHECK(refusal({"", "", {"1/2/3"}}) == "--exclude");
  CHECK(refusal({"1", "2", {"1/2"}}) == "none");
}

TEST_CASE("what was used is told stretch by stretch") {
  UsedStretches used;
  for (const std::int64_t second : {1, 2, 3, 4, 5, 6})
    used.note(second, second != 1 && second != 4);
  REQUIRE(used.stretches().size() == 2);
  CHECK(used.stretches()[0].from_ns == 2);
  CHECK(used.stretches()[0].until_ns == 3);
  CHECK(used.stretches()[1].from_ns == 5);
  CHECK(used.stretches()[1].until_ns == 6);
}

}  // namespace
}  // namespace mpm::files
