// Tables of results: CSV and JSON with exact numbers, and aligned text for people.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lib/base/json.h"
#include "lib/base/output_file.h"

namespace pbf::io_module {

/// A value of a table; monostate: missing.
using Cell = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

/// Missing for NaN.
Cell known(double value);

/// A column of a table of rows of type Row. Width and number concern people only.
template <class Row>
struct Column {
  std::string name;
  std::function<Cell(const Row&)> value{};
  int width = 0;                ///< at least; below 0: flush left
  const char* number = "{:g}";  ///< format of a double
};

class Table {
 public:
  explicit Table(const std::vector<std::string>& columns);
  /// Throws Error(internal) when the row has another length than the columns.
  void add(std::vector<Cell> row);
  std::size_t rows() const { return rows_.size(); }
  /// After RFC 4180: a header of column names, one line per row, text quoted where needed, empty
  /// for a missing value, nan and inf in these words, numbers in the shortest form that reads back
  /// as the same number.
  std::string csv() const;
  /// The rows as an array of objects keyed by column.
  Json json() const;
  /// Aligned lines for people, the names first, "-" for a missing value.
  std::string text(const std::string& indent = "") const;

 protected:
  struct Form {
    std::string name;
    int width;
    const char* number;
  };
  std::vector<Form> columns_;

 private:
  std::vector<std::vector<Cell>> rows_;
};

/// A table whose columns know where their values are in a row.
template <class Row>
class TableOf : public Table {
 public:
  explicit TableOf(std::vector<Column<Row>> columns, const std::vector<Row>& rows = {})
      : Table({}), values_(std::move(columns)) {
    for (const Column<Row>& c : values_) columns_.push_back({c.name, c.width, c.number});
    for (const Row& row : rows) add(row);
  }
  void add(const Row& row) {
    std::vector<Cell> cells;
    for (const Column<Row>& c : values_) cells.push_back(c.value(row));
    Table::add(std::move(cells));
  }

 private:
  std::vector<Column<Row>> values_;
};

}  // namespace pbf::io_module
