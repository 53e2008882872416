#include <catch2/catch.hpp>

#include "config/suggest.hpp"

using namespace mpm::config;

TEST_CASE("Edit distance counts slips, swaps as one, case as none") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("abc", "") == 3);
  CHECK(edit_distance("kitten", "sitting") == 3);  // Levenshtein's textbook pair
  CHECK(edit_distance("gian", "gain") == 1);
  CHECK(edit_distance("FIC101", "fic101") == 0);
}

TEST_CASE("A suggestion is made only for a likely slip") {
  CHECK(suggestion("dead_tme", {"gain", "dead_time"}) == " (did you mean 'dead_time'?)");
  CHECK(suggestion("wibble", {"gain", "lead"}) == " (known: gain, lead)");
  CHECK(suggestion("x", {"u"}) == " (known: u)");
  CHECK(suggestion("x", {}).empty());
  CHECK(suggestion("wibble", std::vector<std::string>(50, "long_tag_name")).empty());
}

TEST_CASE("Long lists are cut") {
  CHECK(join({"a", "b", "c"}) == "a, b, c");
  CHECK(join({"a", "b", "c"}, 2) == "a, b ... (1 more)");
}
