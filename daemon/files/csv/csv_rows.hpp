#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/files/csv/column.hpp"
#include "daemon/files/csv/row_source.hpp"
#include "daemon/files/frame_source.hpp"

namespace mpm::files {

/// The rows of a data file as they stand there: no unit has to know its tags and no sample time
/// its rows. The frames have no interval numbers.
class CsvRows : public FrameSource {
 public:
  /// All tags of the file, as aux signals: called as `unit` calls them where it names them, and
  /// with what it calculates from them. Null = no unit. Throws config::InputError where it cannot
  /// be read.
  explicit CsvRows(const std::string& path, const TimeStyle& times = {},
                   const config::UnitConfig* unit = nullptr);

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] const std::vector<std::string>& notices() const override { return notices_; }
  /// In the order of the file, then what is calculated.
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  /// `wide`, `long` or `pairs`.
  [[nodiscard]] const char* layout() const;
  [[nodiscard]] char delimiter() const { return format_.delimiter; }

 private:
  /// Turns names of the file into the unit's tags.
  void call_as(const config::UnitConfig& known, int header_line, std::vector<std::string>& tags);

  LineReader lines_;
  CsvFormat format_;
  std::vector<Column> columns_;
  std::unique_ptr<TagTable> tags_;
  std::unique_ptr<RowSource> rows_;
  std::vector<std::string> notices_;
};

}  // namespace mpm::files
