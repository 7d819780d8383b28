#include "lib/io/table.h"

#include <fmt/core.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"

namespace pbf::io_module {
namespace {

std::string number(double v) {
  if (std::isnan(v)) return "nan";  // of either sign
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, v).ptr;
  return {buffer, end};
}

std::string plain(const Cell& value) {
  if (const auto* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const auto* i = std::get_if<std::int64_t>(&value)) return std::to_string(*i);
  if (const auto* d = std::get_if<double>(&value)) return number(*d);
  if (const auto* s = std::get_if<std::string>(&value)) return *s;
  return {};
}

std::string csv_text(const std::string& text) {
  const std::string s = escaped(text);
  if (s.find_first_of(",\"\r\n") == std::string::npos) return s;
  return (std::ostringstream() << std::quoted(s, '"', '"')).str();
}

/// As people read it.
std::string word(const Cell& value, const char* number_format) {
  if (std::holds_alternative<std::monostate>(value)) return "-";
  const auto* d = std::get_if<double>(&value);
  return d ? fmt::format(fmt::runtime(number_format), *d) : plain(value);
}

}  // namespace

Cell known(double value) { return std::isnan(value) ? Cell() : Cell(value); }

Table::Table(const std::vector<std::string>& columns) {
  for (const std::string& name : columns) columns_.push_back({name, 0, "{:g}"});
}

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns_.size())
    throw Error(ExitCode::internal, "table: a row of " + std::to_string(row.size()) +
                                        " values for " + std::to_string(columns_.size()) +
                                        " columns");
  rows_.push_back(std::move(row));
}

std::string Table::csv() const {
  std::string out;
  const auto line = [&out](const auto& values, auto print) {
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (c) out += ',';
      out += csv_text(print(values[c]));
    }
    out += '\n';
  };
  line(columns_, [](const Form& column) { return column.name; });
  for (const auto& row : rows_) line(row, plain);
  return out;
}

Json Table::json() const {
  Json out = Json::array();
  for (const auto& row : rows_) {
    Json& object = out.emplace_back(Json::object());
    for (std::size_t c = 0; c < row.size(); ++c)
      std::visit(
          [&value = object[columns_[c].name]](const auto& v) {
            if constexpr (!std::is_same_v<decltype(v), const std::monostate&>) value = v;
          },
          row[c]);
  }
  return out;
}

std::string Table::text(const std::string& indent) const {
  std::vector<std::vector<std::string>> lines(1);
  std::vector<std::size_t> widths;
  for (const Form& column : columns_) {
    lines[0].push_back(column.name);
    widths.push_back(static_cast<std::size_t>(std::abs(column.width)));
  }
  for (const auto& row : rows_) {
    auto& line = lines.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c) line.push_back(word(row[c], columns_[c].number));
  }
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string out;
  for (const auto& line : lines) {
    std::string text = indent;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const std::string blanks(widths[c] - line[c].size(), ' ');
      if (c) text += ' ';
      text += columns_[c].width < 0 ? line[c] + blanks : blanks + line[c];
    }
    text.erase(text.find_last_not_of(' ') + 1);
    out += text;
    out += '\n';
  }
  return out;
}

}  // namespace pbf::io_module
