#include "daemon/report/diagnosis/other_row.hpp"

namespace mpm::report {

std::string other_row_name(OtherRow row) {
  switch (row) {
    case OtherRow::kEarlier:
      return "a row earlier";
    case OtherRow::kLater:
      return "a row later";
    case OtherRow::kNone:
      break;
  }
  return "";
}

std::string other_row_text(OtherRow row) {
  if (row == OtherRow::kNone) return "";
  return "Time stamps: with the CVs " + other_row_name(row) +
         " no channel mismatches. They are probably logged a row too " +
         (row == OtherRow::kEarlier ? "late" : "early") +
         " beside the MVs: see when the historian reads them, rather than repair the model";
}

}  // namespace mpm::report
