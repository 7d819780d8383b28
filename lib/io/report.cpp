#include "lib/io/report.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"
#include "lib/base/text.h"

namespace pbf::inline io_module {
namespace {

std::string number(double v) {
  if (std::isnan(v)) return "nan";
  if (std::isinf(v)) return v > 0 ? "inf" : "-inf";
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

std::string csv(const std::string& text) {
  const std::string s = escaped(text);
  if (s.find_first_of(",\"\r\n") == std::string::npos) return s;
  std::string out = "\"";
  for (const char c : s) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

}  // namespace

std::string json(const Cell& value) {
  if (const auto* s = std::get_if<std::string>(&value)) return json_string(*s);
  if (const auto* d = std::get_if<double>(&value); d && !std::isfinite(*d)) return "null";
  return std::holds_alternative<std::monostate>(value) ? "null" : plain(value);
}

std::string json_array(const std::vector<std::string>& items) {
  std::string out = "[";
  for (const auto& item : items) out += (out.size() > 1 ? ",\n " : "") + item;
  return out + "]";
}

void CsvTable::add(std::vector<Cell> row) {
  if (row.size() != columns_.size())
    throw Error(ExitCode::internal, "report: a row of " + std::to_string(row.size()) +
                                        " values for " + std::to_string(columns_.size()) +
                                        " columns");
  rows_.push_back(std::move(row));
}

std::string CsvTable::text() const {
  std::string out;
  const auto line = [&out](const auto& values, auto print) {
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (c) out += ',';
      out += csv(print(values[c]));
    }
    out += '\n';
  };
  line(columns_, [](const std::string& name) { return name; });
  for (const auto& row : rows_) line(row, plain);
  return out;
}

std::string CsvTable::json() const {
  std::vector<std::string> items;
  for (const auto& row : rows_) {
    JsonObject object;
    for (std::size_t c = 0; c < row.size(); ++c) object.add(columns_[c], row[c]);
    items.push_back(object.text());
  }
  return json_array(items);
}

JsonObject& JsonObject::add(const std::string& key, const Cell& value) {
  return add_json(key, json(value));
}

JsonObject& JsonObject::add_json(const std::string& key, const std::string& text) {
  members_.emplace_back(key, text);
  return *this;
}

std::string JsonObject::text() const {
  std::string out = "{";
  for (const auto& [key, value] : members_)
    out += (out.size() > 1 ? ", " : "") + json_string(key) + ": " + value;
  return out + "}";
}

}  // namespace pbf::inline io_module
