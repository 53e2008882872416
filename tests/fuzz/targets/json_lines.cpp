#include <memory>
#include <sstream>

#include "daemon/bag/lifecycle.hpp"
#include "daemon/files/csv/line_frames.hpp"
#include "daemon/history/read_journal.hpp"
#include "daemon/http/command_json.hpp"
#include "tests/fuzz/small_unit.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {
namespace {

// As `mpm publish` reads them: a bad line is told, and the next one taken.
void publish(const std::string& text) {
  std::unique_ptr<files::LineFrames> lines;
  if (!tolerate([&] {
        lines =
            std::make_unique<files::LineFrames>(std::make_unique<std::istringstream>(text), "stdin",
                                                files::LineFormat::kAuto, small_unit());
      }))
    return;
  Frame frame;
  for (std::size_t turn = 0;; ++turn) {
    require(turn <= text.size() + 1, "lines without an end");
    bool more = true;
    tolerate([&] { more = lines->next(frame); });
    if (!more) return;
    static_cast<void>(lines->take_notices());
  }
}

}  // namespace

void json_lines(std::string_view bytes) {
  const std::string text(bytes);
  publish(text);
  const std::string file = as_file(bytes);
  tolerate([&] { static_cast<void>(history::journal_of({file}, "")); });
  tolerate([&] {
    history::read_journal(file, {[](const history::UnitHead&) {}, [](const history::Digest&) {},
                                 [](const history::AlarmChangeNote&) {}});
  });
  static_cast<void>(http::parse_command(text));
  static_cast<void>(bag::parse_lifecycle(bytes));
}

}  // namespace mpm::fuzz
