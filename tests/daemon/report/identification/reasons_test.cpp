#include "daemon/report/identification/reasons.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/daemon/report/identification/small_run.hpp"

namespace mpm::test {

TEST_CASE("every reason has a word of its own and a sentence") {
  std::set<std::string> words;
  const report::IdentificationRun run = small_run();
  ChannelAnswer answer = run.identification.channels[0];
  const int last = static_cast<int>(LeftOut::kNotConfirmed);
  for (int reason = 0; reason <= last; ++reason) {
    answer.left_out = static_cast<LeftOut>(reason);
    words.insert(report::reason_word(answer.left_out));
    CHECK(report::reason_text(run, answer).empty() == (reason == 0));
  }
  CHECK(words.size() == static_cast<std::size_t>(last) + 1);
  CHECK(words.count("") == 0);
}

TEST_CASE("a vague gain names the input that it cannot be told from") {
  const report::IdentificationRun run = small_run();
  ChannelAnswer answer = run.identification.channels[0];
  answer.left_out = LeftOut::kVague;
  answer.entangled_with = 1;
  CHECK(report::reason_text(run, answer).find("cannot be told from that of v") !=
        std::string::npos);
}

}  // namespace mpm::test
