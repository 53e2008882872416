#include "core/archive/archive.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <stdexcept>

namespace mpm {
namespace {

enum class Colour : unsigned char { kRed, kGreen };

struct Part {
  int number = 0;
  template <class Archive>
  void archive(Archive& a) {
    a(number);
  }
};

// Of each kind of member that classes have. `fixed` has as many parts as construction gave it.
struct Everything {
  explicit Everything(std::size_t parts) : fixed(parts), flags(parts, false), matrix(2, parts) {
    matrix.setZero();
  }
  double real = 0.0;
  std::int64_t time_ns = 0;
  std::uint64_t count = 0;
  bool flag = false;
  Colour colour = Colour::kRed;
  int place = 0;
  std::string text;
  std::optional<Part> perhaps;
  std::vector<Part> fixed, any;
  std::vector<bool> flags;
  std::array<double, 2> pair{};
  Eigen::MatrixXd matrix;

  void archive(Archive& a) {
    a(real, count, flag, text, perhaps, fixed, flags, pair, matrix);
    a.time(time_ns);
    a.within(colour, Colour::kRed, Colour::kGreen);
    a.within(place, 0, 9);
    a.varying(any);
  }
};

Everything filled() {
  Everything all(3);
  all.real = std::bit_cast<double>(0x7ff8dead0000beefULL);  // a NaN with something in it
  all.time_ns = std::numeric_limits<std::int64_t>::min();
  all.count = 1ULL << 63;
  all.flag = true;
  all.colour = Colour::kGreen;
  all.place = 9;
  all.text = std::string("a\0b", 3);
  all.perhaps = Part{7};
  all.fixed = {{1}, {2}, {-3}};
  all.any = {{4}, {5}};
  all.flags = {true, false, true};
  all.pair = {0.1, -0.0};
  all.matrix << 1, 2, 3, 4, 5, 6;
  return all;
}

TEST_CASE("what was put away is taken back to the last bit") {
  const Everything all = filled();
  const std::vector<std::byte> bytes = put_away(all);
  Everything back(3);
  back.any = {{9}, {9}, {9}};
  take_back(bytes, back);
  CHECK(std::bit_cast<std::uint64_t>(back.real) == 0x7ff8dead0000beefULL);
  CHECK(back.time_ns == all.time_ns);
  CHECK(back.count == all.count);
  CHECK(back.flag);
  CHECK(back.colour == Colour::kGreen);
  CHECK(back.place == 9);
  CHECK(back.text == all.text);
  REQUIRE(back.perhaps);
  CHECK(back.perhaps->number == 7);
  REQUIRE(back.any.size() == 2);
  CHECK(back.any[1].number == 5);
  CHECK(back.fixed[2].number == -3);
  CHECK(back.flags == all.flags);
  CHECK(std::signbit(back.pair[1]));
  CHECK(back.matrix == all.matrix);
  CHECK(put_away(back) == bytes);

  const Everything none(3);
  take_back(put_away(none), back);
  CHECK_FALSE(back.perhaps);
  CHECK(back.any.empty());
}

TEST_CASE("several objects follow each other in one blob") {
  Part a{1}, b{2};
  const Everything all = filled();
  Everything back(3);
  take_back(put_away(Part{3}, all, Part{4}), a, back, b);
  CHECK(a.number == 3);
  CHECK(b.number == 4);
}

TEST_CASE("what does not fit is refused, and said how") {
  const std::vector<std::byte> bytes = put_away(filled());
  const auto refused = [](const std::vector<std::byte>& given, std::size_t parts = 3) {
    Everything back(parts);
    try {
      take_back(given, back);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused(bytes).empty());
  CHECK_THAT(refused(bytes, 4), Catch::Contains("3 values where 4 belong"));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CAPTURE(length);
    CHECK_FALSE(
        refused({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}).empty());
  }
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  CHECK_THAT(refused(longer), Catch::Contains("more bytes"));
}

TEST_CASE("who puts much away is asked before every megabyte whether to stop") {
  std::vector<double> much(1 << 19, 1.5);  // four megabytes, and eight bytes for their count
  std::vector<std::byte> whole;
  Archive away(whole);
  away(much);
  std::vector<std::byte> asked_for;
  int asked = 0;
  Archive patient(asked_for, [&] { return ++asked > 100; });
  patient(much);
  CHECK(asked == 5);
  CHECK(asked_for == whole);
  for (int last = 1; last <= 5; ++last) {
    std::vector<std::byte> bytes;
    asked = 0;
    Archive stopped(bytes, [&] { return ++asked == last; });
    CHECK_THROWS_AS(stopped(much), Archive::Stopped);
    CHECK(bytes.size() == (static_cast<std::size_t>(last) - 1) << 20);
    CHECK(much == std::vector<double>(1 << 19, 1.5));
  }
}

// A listing that names what is of the wrong size or beyond its limits, as bytes alone can have it.
TEST_CASE("no number gets beyond its limits, and no list takes more than the bytes stand for") {
  const auto of = [](std::int64_t number) {
    std::vector<std::byte> bytes;
    Archive(bytes).time(number);
    return bytes;
  };
  const auto read = [](const std::vector<std::byte>& bytes, auto each) {
    Archive archive{std::span<const std::byte>(bytes)};
    each(archive);
  };
  std::size_t index = 2;
  CHECK_NOTHROW(read(of(9), [&](Archive& a) { a.within(index, 0, 9); }));
  CHECK(index == 9);
  for (const std::int64_t beyond : {std::int64_t{-1}, std::int64_t{10}})
    CHECK_THROWS_AS(read(of(beyond), [&](Archive& a) { a.within(index, 0, 9); }),
                    std::runtime_error);
  CHECK(index == 9);  // as it was
  Colour colour = Colour::kRed;
  CHECK_THROWS_AS(read(of(2), [&](Archive& a) { a.within(colour, Colour::kRed, Colour::kGreen); }),
                  std::runtime_error);

  std::vector<double> list;
  std::string text;
  std::vector<Part> parts;
  for (const std::int64_t length : {std::int64_t{1}, std::int64_t{1} << 40, std::int64_t{-1}}) {
    CHECK_THROWS_AS(read(of(length), [&](Archive& a) { a.varying(list); }), std::runtime_error);
    CHECK_THROWS_AS(read(of(length), [&](Archive& a) { a.varying(parts); }), std::runtime_error);
    CHECK_THROWS_AS(read(of(length), [&](Archive& a) { a(text); }), std::runtime_error);
  }
  CHECK(list.capacity() <= 1);

  // Sums of two counts are still numbers; a flag is one of two.
  std::int64_t count = 0;
  CHECK_THROWS_AS(read(of(std::numeric_limits<std::int64_t>::max()), [&](Archive& a) { a(count); }),
                  std::runtime_error);
  bool flag = false;
  CHECK_THROWS_AS(read(of(2), [&](Archive& a) { a(flag); }), std::runtime_error);
}

}  // namespace
}  // namespace mpm
