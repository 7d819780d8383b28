#include "lib/scene/remedies.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "lib/base/plain_text.h"

namespace pbf::scene_module {
namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool is_of_key(char c) {
  return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) || c == '.';
}

/// The key at the beginning of a text; empty if there is none.
std::string first_key(const std::string& text) {
  if (text.empty() || !is_letter(text[0])) return "";
  return {text.begin(), std::find_if_not(text.begin(), text.end(), is_of_key)};
}

std::string colon_missing(const std::string& key) {
  return "; a colon is missing behind \"" + one_line(key, 40) + "\"";
}

std::string on_line(std::size_t number) { return " on line " + std::to_string(number + 1); }

/// Calls f(i) for every character of a line outside quotes. Returns where its comment begins.
template <class F>
std::size_t visit_plain(const std::string& line, F f) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '#' && (i == 0 || line[i - 1] == ' ')) {
      return i;
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else {
      f(i);
    }
  }
  return line.size();
}

/// The unchanged lines up to line `last`.
std::vector<std::string> raw_lines(const std::string& text, int last) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; int(lines.size()) <= last && std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

/// A line of a file.
struct Line {
  std::size_t indent;
  std::string text;    ///< without the comment and surrounding blanks
  std::size_t number;  ///< from 0
};

/// Lines outside brackets, without empty ones.
std::vector<Line> block_lines(const std::vector<std::string>& raw) {
  std::vector<Line> lines;
  int depth = 0;
  for (std::size_t number = 0; number < raw.size(); ++number) {
    std::string line = raw[number];
    int opened = 0;
    line.resize(visit_plain(line, [&](std::size_t i) {
      opened += (line[i] == '[' || line[i] == '{') - (line[i] == ']' || line[i] == '}');
    }));
    const std::size_t first = line.find_first_not_of(" \r");
    if (first != line.npos && depth == 0)
      lines.push_back(
          {first, line.substr(first, line.find_last_not_of(" \r") + 1 - first), number});
    depth = std::max(0, depth + opened);
  }
  return lines;
}

/// "step: 0.002": a key with its value on the same line.
bool has_value(const std::string& line) {
  const std::size_t colon = line.find(": ");
  return colon != line.npos && is_letter(line[0]) && line.find_first_of("\"'{[") > colon;
}
bool is_key(const std::string& line) {
  return is_letter(line[0]) && (has_value(line) || line.back() == ':');
}

std::string indentation_remedy(const std::vector<Line>& lines) {
  std::vector<std::size_t> levels;  // indentations of the enclosing blocks
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    const std::string place = "line " + std::to_string(line.number + 1);
    while (!levels.empty() && levels.back() > line.indent) levels.pop_back();
    if (i > 0 && line.indent > lines[i - 1].indent && is_key(line.text) &&
        has_value(lines[i - 1].text))
      return "; " + place +
             " is indented deeper than the line before it, which has a value of its "
             "own: keys of one block begin in the same column";
    if (i > 0 && line.indent < lines[i - 1].indent &&
        (levels.empty() || levels.back() != line.indent))
      return "; " + place +
             " is indented like no line above it: keys of one block begin in the "
             "same column";
    if (levels.empty() || levels.back() < line.indent) levels.push_back(line.indent);
    // The text after a dash begins a block of its own.
    if (line.text.size() > 2 && line.text[0] == '-' && line.text[1] == ' ')
      levels.push_back(line.indent + line.text.find_first_not_of(' ', 1));
  }
  return "";
}

/// "{min:[0, 0, 0]}": "; a space is missing behind "min:"".
std::string missing_space_before_bracket(const std::string& line) {
  std::string found;
  visit_plain(line, [&](std::size_t i) {
    if (!found.empty() || line[i] != ':' || i + 1 >= line.size() ||
        (line[i + 1] != '[' && line[i + 1] != '{'))
      return;
    std::size_t first = i;
    while (first > 0 && is_of_key(line[first - 1])) --first;
    if (first < i) found = missing_space(line.substr(first, i + 2 - first));
  });
  return found;
}

/// "domain {min: ...}", or "output" above a line that is indented more.
std::string missing_colon_of_block(const std::vector<Line>& lines) {
  const std::size_t n = lines.size();
  for (std::size_t k = n; k-- > (n < 2 ? 0 : n - 2);) {
    const std::string& text = lines[k].text;
    const std::string key = first_key(text);
    if (key.empty()) continue;
    const std::size_t end = key.size();
    const std::size_t next = text.find_first_not_of(' ', end);
    const bool before_bracket =
        next != text.npos && next > end && (text[next] == '{' || text[next] == '[');
    const bool above_block =
        next == text.npos && k + 1 < n && lines[k + 1].indent > lines[k].indent;
    if (before_bracket || above_block) return colon_missing(key) + on_line(lines[k].number);
  }
  return "";
}

/// For a list or a block in brackets whose end yaml-cpp does not find.
std::string missing_bracket(const std::vector<std::string>& lines) {
  std::vector<std::pair<char, std::size_t>> open;  // brackets and their lines
  for (std::size_t k = 0; k + 1 < lines.size(); ++k)
    visit_plain(lines[k], [&](std::size_t i) {
      const char c = lines[k][i];
      if (c == '[' || c == '{') open.emplace_back(c, k);
      if ((c == ']' || c == '}') && !open.empty()) open.pop_back();
    });
  if (open.empty()) return "; a comma, a colon or a closing bracket is missing on this line";
  return std::string("; the ") + open.back().first + on_line(open.back().second) +
         " is not closed, or a comma is missing";
}

}  // namespace

std::string missing_space(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == text.npos || colon == 0 || colon + 1 >= text.size() || !is_letter(text[0]) ||
      text[colon + 1] == ' ' || text[colon + 1] == '/')
    return "";
  const std::string key = text.substr(0, colon);
  if (!std::all_of(key.begin(), key.end(), is_of_key)) return "";
  return "; a space is missing behind \"" + one_line(key, 40) + ":\"";
}

std::string missing_colon(const std::string& text) {
  const std::string key = first_key(text);
  return key.empty() || !text.substr(key.size()).starts_with(' ') ? "" : colon_missing(key);
}

std::string layout_remedy(const std::string& text, int line, const std::string& reason) {
  const std::vector<std::string> raw = raw_lines(text, line);
  const std::vector<Line> lines = block_lines(raw);
  // YAML reports the line after the mistake, since a text may continue there.
  for (std::size_t back = 0; back < std::min<std::size_t>(2, lines.size()); ++back) {
    const Line& l = lines[lines.size() - 1 - back];
    if (l.text.size() > 1 && l.text[0] == '-' &&
        std::string("{[").find(l.text[1]) != std::string::npos)
      return "; a space is missing behind the \"-\"" + on_line(l.number);
    const std::size_t dash = l.text.rfind("- ", 0) == 0 ? l.text.find_first_not_of(' ', 1) : 0;
    if (const std::string found = missing_space(l.text.substr(dash)); !found.empty())
      return found + on_line(l.number);
  }
  for (std::size_t k = raw.size(); k-- > 0 && k + 2 >= raw.size();)
    if (const std::string found = missing_space_before_bracket(raw[k]); !found.empty())
      return found + on_line(k);
  if (const std::string found = missing_colon_of_block(lines); !found.empty()) return found;
  if (reason.find("flow not found") != reason.npos || reason.find("flow end") != reason.npos)
    return missing_bracket(raw);
  return indentation_remedy(lines);
}

}  // namespace pbf::scene_module
