#include "lib/io/csv.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"

namespace pbf::io_module {

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r'))
    s.remove_suffix(1);
  return s;
}

std::string_view without_mark(std::string_view line) {
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  return line;
}

std::string wrong_header(const std::string& header) {
  constexpr std::string_view kLetters = "xyzuvwtrangleXYZUVWTR_,;:| \t";
  if (header.size() <= 40 && header.find_first_not_of(kLetters) == std::string::npos)
    return "the header is \"" + header + "\"" + separator_remedy(header);
  if (header.find_first_not_of("0123456789+-.eE,; \t") == std::string::npos)
    return "the first line holds numbers, no header";
  return "the first line is no header (" + std::to_string(1 + std::ranges::count(header, ',')) +
         " columns; not shown, for the file may be anything)";
}

std::string separator_remedy(const std::string& header) {
  const bool other = header.find(',') == header.npos && header.find_first_of("; \t") != header.npos;
  return other ? "; commas part the columns, decimals take a point" : "";
}

CsvLines::CsvLines(RegularFile& file, const std::string& path, CsvOptions options)
    : file_(file), path_(path), options_(std::move(options)), block_(std::size_t{1} << 16) {}

bool CsvLines::next(std::string& line) {
  line.clear();
  for (bool any = false;; any = true) {
    if (at_ == size_) {
      size_ = file_.read(block_.data(), block_.size());
      at_ = 0;
      if (size_ == 0) {  // the last line may lack its end
        number_ += any;
        return any;
      }
      if (options_.hash) options_.hash->add({block_.data(), size_});
    }
    const char* begin = block_.data() + at_;
    const void* end = std::memchr(begin, '\n', size_ - at_);
    const std::size_t n = end ? std::size_t(static_cast<const char*>(end) - begin) : size_ - at_;
    if (line.size() + n > options_.longest)
      bad_input(where(number_ + 1), "the line is longer than " + std::to_string(options_.longest) +
                                        " bytes, " + options_.expected);
    line.append(begin, n);
    at_ += n + (end ? 1 : 0);
    if (!end) continue;
    ++number_;
    return true;
  }
}

std::vector<CsvRow> read_csv(const std::string& path, const std::string& remedy,
                             std::string* sha256) {
  RegularFile file(path, "a CSV table", remedy);
  Sha256 hash;
  CsvLines lines(file, path, {.hash = sha256 ? &hash : nullptr});
  std::vector<CsvRow> rows;
  for (std::string line; lines.next(line);) {
    const auto fail = [&](const std::string& what) { bad_input(lines.where(), what + remedy); };
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (const auto found = find_bad_text(line)) fail(found->what + "; " + found->remedy);
    if (lines.number() == 1) line = std::string(without_mark(line));
    if (trimmed(line).empty() || line[0] == '#') continue;
    CsvRow row{lines.where(), {}, lines.number()};
    for (std::string_view rest = line;;) {
      const std::size_t comma = rest.find(',');
      row.cells.emplace_back(trimmed(rest.substr(0, comma)));
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    if (!rows.empty() && row.cells.size() != rows[0].cells.size())
      fail("has " + std::to_string(row.cells.size()) + " values, the header names " +
           std::to_string(rows[0].cells.size()) + separator_remedy(rows[0].cells[0]));
    rows.push_back(std::move(row));
  }
  if (sha256) *sha256 = hash.text();
  return rows;
}

}  // namespace pbf::io_module
