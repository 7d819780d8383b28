// Reads CSV files: lines, cells, and small tables. table.h writes them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lib/base/regular_file.h"
#include "lib/base/sha256.h"

namespace pbf::io_module {

/// Without blanks at its ends, and without the carriage return of a Windows line.
std::string_view trimmed(std::string_view text);

/// Of a first line: without the byte order mark of spreadsheets.
std::string_view without_mark(std::string_view line);

/// What a first line is that is no header that was expected: "the header is ...", and what is wrong
/// with its separators. It is quoted only where it consists of what headers consist of: it may be
/// the first line of anything.
std::string wrong_header(const std::string& header);
/// The same of separators alone; empty: they are commas.
std::string separator_remedy(const std::string& header);

/// How a file's lines are read.
struct CsvOptions {
  Sha256* hash = nullptr;                         ///< gets the bytes that are read
  std::size_t longest = std::size_t{1} << 16;     ///< bytes of a line
  std::string expected = "expected a CSV table";  ///< said of a line that is longer
};

/// The lines of a file, read a block at a time.
class CsvLines {
 public:
  /// `file` and `path` must outlive this.
  CsvLines(RegularFile& file, const std::string& path, CsvOptions options = {});
  /// The next line without its end; false at the end of the file. Error(io); Error(bad_input) for a
  /// line that is too long.
  bool next(std::string& line);
  /// "path:line" of the last one.
  std::string where() const { return where(number_); }
  std::int64_t number() const { return number_; }

 private:
  std::string where(std::int64_t line) const { return path_ + ":" + std::to_string(line); }
  RegularFile& file_;
  const std::string& path_;
  CsvOptions options_;
  std::vector<char> block_;
  std::size_t at_ = 0, size_ = 0;
  std::int64_t number_ = 0;
};

/// A row of a small table: where it stands, "path:line", and its cells, trimmed.
struct CsvRow {
  std::string where;
  std::vector<std::string> cells;
  std::int64_t line = 0;
};

/// A small table without quoted cells: the header, then rows of as many cells. Empty lines and
/// those that begin with # are passed over. `remedy` ends every message ("; remove the file").
/// `sha256`: gets the SHA-256 of the bytes that were read, if given; a file that a scene names
/// needs it (SceneFile). Error(io) when the file cannot be read; Error(bad_input) naming the line
/// for a row of another length and for what is no text.
std::vector<CsvRow> read_csv(const std::string& path, const std::string& remedy = "",
                             std::string* sha256 = nullptr);

}  // namespace pbf::io_module
