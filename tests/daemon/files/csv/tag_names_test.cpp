#include "daemon/files/csv/tag_names.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace mpm::files;

namespace {

bool may_be(const std::string& name, const std::string& tag) {
  const std::vector<std::string> forms = plain_tags(name);
  return std::find(forms.begin(), forms.end(), tag) != forms.end();
}

}  // namespace

TEST_CASE("A name stands for itself first, then for what is left without its decorations") {
  CHECK(plain_tags("Q1") == std::vector<std::string>{"Q1"});
  const std::string name = GENERATE(values<std::string>(
      {"[Q1]", "\\\\SERVER\\Q1", "Q1 [degC]",
       "Q1 [\xC2\xB0"
       "C]",
       "[default]Heater/Q1", "Q1 (PV)", "Q1.PV", "Q1.Value", "Heater/Q1",
       "\\\\AF\\Plant\\Heater|Q1", "[default]Plant/Heater/Q1.Value [%]", "Heater/Q1/PV.CV"}));
  CAPTURE(name);
  CHECK(plain_tags(name).front() == name);
  CHECK(may_be(name, "Q1"));
}

TEST_CASE("Folders may be part of the tag") {
  CHECK(may_be("[default]Plant/Heater/Q1", "Heater/Q1"));
  CHECK(may_be("[default]Plant/Heater/Q1", "Plant/Heater/Q1"));
}

TEST_CASE("Another property of a tag is not the tag") {
  const std::string name = GENERATE(values<std::string>(
      {"Q1 (SP)", "Q1.SP", "Q1 [Mode]", "Q1/OP", "Q1_PV", "Q1.Quality", "Q1 (status)", "Q12"}));
  CAPTURE(name);
  CHECK_FALSE(may_be(name, "Q1"));
}

TEST_CASE("What is no tag is looked into only so far") {
  CHECK(plain_tags(std::string(100'000, '/')).size() == 1);
  std::string folders;
  for (int i = 0; i < 200; ++i) folders += "a/";
  CHECK(plain_tags(folders + "b").size() <= 64);
}
