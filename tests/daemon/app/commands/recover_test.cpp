#include <catch2/catch.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "daemon/mcap/write/writer.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {

TEST_CASE("recover: where nothing can be kept nothing is written, and the exit code says so") {
  const TemporaryFolder folder;
  const std::string whole = folder.file("whole.mcap"), torn = folder.file("torn.mcap");
  const std::string mended = folder.file("mended.mcap");
  {
    mcap::Writer writer(whole, {});
    const auto channel = writer.add_channel(0, "a", "json");
    writer.write(channel, 1, 1, std::as_bytes(std::span(std::string_view("one"))));
    writer.finish();
  }
  const auto recover = [&](const std::string& input) {
    return run({"mpm", "recover", input, "--output", mended}, folder.file("out"),
               folder.file("err"));
  };
  constexpr std::size_t kHeader = 30;  // the magic bytes, and no whole record behind them
  write_file(torn, read_file(whole).substr(0, kHeader));
  CHECK(recover(torn) == 3);
  CHECK_THAT(read_file(folder.file("err")),
             Catch::EndsWith("no message of it can be kept; nothing was written\n"));
  CHECK_FALSE(std::filesystem::exists(mended));

  CHECK(recover(whole) == 0);
  CHECK_THAT(read_file(folder.file("out")), Catch::Contains("1 message of 1 channel"));
}

}  // namespace mpm::test
