// Small writers for results: tables as CSV and values as JSON, numbers exact to the last bit.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lib/base/output_file.h"

namespace pbf::inline io_module {

/// A value of a report. A double prints in the shortest form that reads back as the same number.
using Cell = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

/// CSV after RFC 4180: a header of column names, one line per row, text quoted where needed, empty
/// for a missing value, nan and inf in these words.
class CsvTable {
 public:
  explicit CsvTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}
  /// Throws Error(internal) when the row has another length than the header.
  void add(std::vector<Cell> row);
  std::size_t rows() const { return rows_.size(); }
  std::string text() const;
  /// The rows as a JSON array of objects keyed by column.
  std::string json() const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

/// A JSON object (RFC 8259) in the order in which its members were added.
class JsonObject {
 public:
  JsonObject& add(const std::string& key, const Cell& value);
  /// A member whose value is JSON text already: an object, an array.
  JsonObject& add_json(const std::string& key, const std::string& json);
  std::string text() const;

 private:
  std::vector<std::pair<std::string, std::string>> members_;
};

/// A JSON value; nan and inf, which JSON lacks, become null.
std::string json(const Cell& value);
/// A JSON array of JSON texts.
std::string json_array(const std::vector<std::string>& items);

}  // namespace pbf::inline io_module
