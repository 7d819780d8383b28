#include "lib/io/particle_csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "lib/base/error.h"
#include "lib/io/csv.h"

namespace pbf::io_module {
namespace {

constexpr const char* kNames[] = {"x", "y", "z", "vx", "vy", "vz"};
constexpr std::size_t kLongestLine = 4096;  // bytes; six numbers need a few hundred
constexpr const char* kExpected = "expected x,y,z or x,y,z,vx,vy,vz";

bool printable(std::string_view s) {
  return std::all_of(s.begin(), s.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

/// The header without blanks; tells how many columns follow.
int csv_columns(std::string_view line, const std::string& where) {
  std::string header;
  for (char c : trimmed(line))
    if (c != ' ' && c != '\t') header += c;
  header = std::string(without_mark(header));
  if (header == "x,y,z") return 3;
  if (header == "x,y,z,vx,vy,vz") return 6;
  bad_input(where, wrong_header(header) + ", " + kExpected);
}

void parse_row(std::string_view line, int columns, const CsvLines& lines, double* row) {
  int column = 0;
  for (std::string_view rest = line;; ++column) {
    const std::size_t comma = rest.find(',');
    const std::string_view cell = trimmed(rest.substr(0, comma));
    if (column < columns) {
      std::string_view digits = cell;
      if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
      const char* end = digits.data() + digits.size();
      const auto [stop, ec] = std::from_chars(digits.data(), end, row[column]);
      const auto refuse = [&](const char* what) {
        const std::string value = printable(cell)
                                      ? std::string("\"").append(cell.substr(0, 40)) + "\""
                                      : "what stands there, no plain text,";
        bad_input(lines.where(), std::string(kNames[column]) + ": " + value + what);
      };
      if (cell.empty())
        bad_input(lines.where(), std::string(kNames[column]) + ": empty, expected a number");
      if (ec == std::errc::result_out_of_range) refuse(" does not fit a double");
      if (ec != std::errc{} || stop != end) refuse(" is not a number");
      if (!std::isfinite(row[column])) refuse(" is not finite");
    }
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (column + 1 != columns)
    bad_input(lines.where(),
              std::to_string(column + 1) + " columns, the header has " + std::to_string(columns));
}

}  // namespace

Particles read_particle_csv(RegularFile& file, const std::string& path, Sha256* hash) {
  CsvLines lines(file, path, {hash, kLongestLine, kExpected});
  int columns = 0;
  Particles p;
  for (std::string line; lines.next(line);) {
    if (trimmed(line).empty()) continue;
    if (columns == 0) {
      columns = csv_columns(line, lines.where());
      continue;
    }
    double row[6] = {};
    parse_row(line, columns, lines, row);
    p.position.push_back({row[0], row[1], row[2]});
    p.velocity.push_back({row[3], row[4], row[5]});
  }
  if (columns == 0)
    bad_input(path, "empty, expected a header x,y,z or x,y,z,vx,vy,vz and particles");
  return p;
}

}  // namespace pbf::io_module
