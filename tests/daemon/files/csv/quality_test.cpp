#include "daemon/files/csv/quality.hpp"

#include <catch2/catch.hpp>

using namespace mpm;
using namespace mpm::files;

TEST_CASE("Words say what a value is worth") {
  for (const char* word : {"", "good", "Good_Data", "GOOD", "Tag Good", "ok", "True", "gut"})
    CHECK(parse_quality(word) == Quality::kGood);
  for (const char* word : {"uncertain", "Questionable", "Doubtful", "Suspect", "Initial"})
    CHECK(parse_quality(word) == Quality::kUncertain);
  for (const char* word : {"bad", "Bad_Stale", "NOT HISTORIZED", "No Status", "FALSE", "schlecht",
                           "I/O Timeout", "Comm Fail"})
    CHECK(parse_quality(word) == Quality::kBad);
  for (const char* word : {"fine", "Auto", "1.5", "*"}) CHECK_FALSE(parse_quality(word));
}

TEST_CASE("Codes are those of OPC, or of Ignition") {
  const auto quality = [](const char* code) { return *parse_quality(code); };
  // OPC DA: 11, 01, 00 in the upper two of eight bits; OPC HDA has 0x00040000 for raw above them.
  for (const char* code : {"192", "216", "255", "262336"}) CHECK(quality(code) == Quality::kGood);
  for (const char* code : {"64", "68", "88", "262208"}) CHECK(quality(code) == Quality::kUncertain);
  for (const char* code : {"0", "4", "24", "262144", "65536"})
    CHECK(quality(code) == Quality::kBad);
  // Ignition: 256 to 261 uncertain, 300 and on bad, and OPC UA's two bits of 32, signed too.
  for (const char* code : {"256", "261", "1073742080"}) CHECK(quality(code) == Quality::kUncertain);
  for (const char* code : {"300", "404", "500", "516", "-2147483132", "2147483648"})
    CHECK(quality(code) == Quality::kBad);
  // As numbers with decimals, or in hexadecimal.
  for (const char* code : {"192.0", "0xC0", "1.92E2"}) CHECK(quality(code) == Quality::kGood);
  for (const char* code : {"24.0", "0x18", "0"}) CHECK(quality(code) == Quality::kBad);
  for (const char* code : {"192.5", "0x", "0xG0", "1e99"})
    CHECK_FALSE(quality_code(code).has_value());
}

TEST_CASE("Where zero is good the other codes are few") {
  const auto quality = [](const char* code) {
    return *parse_quality(code, QualityKind::kCode, true);
  };
  CHECK(quality("0") == Quality::kGood);
  CHECK(quality("1") == Quality::kBad);
  CHECK(quality("16") == Quality::kUncertain);
  CHECK(quality("133") == Quality::kUncertain);
  CHECK(fits_zero_is_good(16));
  CHECK_FALSE(fits_zero_is_good(192));
  CHECK_FALSE(fits_zero_is_good(24));
}

TEST_CASE("Flags and percentages are told by the column's name") {
  CHECK(quality_kind("Good") == QualityKind::kGoodFlag);
  CHECK(quality_kind("Validity") == QualityKind::kGoodFlag);
  CHECK(quality_kind("Questionable") == QualityKind::kDoubtFlag);
  CHECK(quality_kind("PercentGood") == QualityKind::kConfidence);
  CHECK(quality_kind("Confidence [%]") == QualityKind::kConfidence);
  CHECK(quality_kind("Quality Detail") == QualityKind::kCode);
  CHECK_FALSE(quality_kind("Value"));
  CHECK(quality_rank("OPCQuality") < quality_rank("Quality"));
  CHECK(quality_rank("Quality") < quality_rank("QualityDetail"));
  CHECK(parse_quality("1", QualityKind::kGoodFlag) == Quality::kGood);
  CHECK(parse_quality("0", QualityKind::kGoodFlag) == Quality::kBad);
  CHECK(parse_quality("2", QualityKind::kGoodFlag) == Quality::kBad);
  CHECK(parse_quality("FALSE", QualityKind::kDoubtFlag) == Quality::kGood);
  CHECK(parse_quality("True", QualityKind::kDoubtFlag) == Quality::kUncertain);
  CHECK(parse_quality("100", QualityKind::kConfidence) == Quality::kGood);
  CHECK(parse_quality("50", QualityKind::kConfidence) == Quality::kUncertain);
  CHECK(parse_quality("49,5", QualityKind::kConfidence) == Quality::kBad);
  CHECK(parse_quality("-1", QualityKind::kConfidence) == Quality::kBad);
}
