#include "daemon/bag/mcap_frames.hpp"
#include "tests/fuzz/exercise_mcap.hpp"
#include "tests/fuzz/small_unit.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {

void mcap(std::string_view bytes) {
  const std::string file = as_file(bytes);
  test::exercise_mcap(file, folder() + "/mended.mcap");
  for (const files::Purpose purpose : {files::Purpose::kJudge, files::Purpose::kKeep})
    tolerate([&] {
      bag::McapFrames frames({file}, small_unit(), purpose);
      Frame frame;
      while (frames.next(frame)) {
      }
    });
}

}  // namespace mpm::fuzz
