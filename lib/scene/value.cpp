#include "lib/scene/value.h"

#include <algorithm>
#include <type_traits>

#include "lib/base/text.h"
#include "lib/scene/number.h"
#include "lib/scene/remedies.h"
#include "lib/scene/suggest.h"

namespace pbf::scene_module {
namespace {

std::string instead_of(const std::string& wanted, const Node& node) {
  return "expected " + wanted + ", got " + node.shown();
}

std::string check_range(const Key& key, double v, const Node& node) {
  if (in_range(key, v)) return "";
  const std::string unit = key.unit.empty() ? "" : " " + key.unit;
  return node.shown() + " is out of range, allowed: " + range_text(key) + unit;
}

/// One number, double or integer.
template <class T>
std::string read_one(const Key& key, const Node& node, T& out) {
  constexpr bool whole = std::is_integral_v<T>;
  const std::string wanted =
      std::string(whole ? "a whole number" : "a number") + (key.automatic ? " or auto" : "");
  if (node.kind != Node::Kind::scalar) return instead_of(wanted, node);
  if (node.quoted) {
    const std::string remedy = number_remedy(node.text, key.unit);
    return instead_of(wanted, node) + (remedy.empty() ? " in quotes; remove them" : remedy);
  }
  std::conditional_t<whole, std::int64_t, double> v{};
  const NumberError error = read_number(node.text, v);
  if (error == NumberError::not_a_number)
    return instead_of(wanted, node) + number_remedy(node.text, key.unit);
  if (error != NumberError::none)
    return node.shown() + " " + describe(error) + ", expected " + wanted;
  const std::string problem = check_range(key, static_cast<double>(v), node);
  if (problem.empty()) out = static_cast<T>(v);
  return problem;
}

/// A list of N numbers, e.g. a vector.
template <class T, std::size_t N>
std::string read_numbers(const Key& key, const Node& node, std::array<T, N>& out) {
  static const char* const kShape = N == 3 ? "[x, y, z]" : "[a, b]";
  if (node.kind != Node::Kind::list || node.items.size() != N)
    return instead_of(std::to_string(N) + " numbers " + kShape + (key.automatic ? " or auto" : ""),
                      node) +
           (N == 3 && node.items.size() == 2 && key.flat != FlatY::none
                ? "; two, [x, z], do with dimensions: 2"
                : "") +
           (node.kind == Node::Kind::scalar ? list_remedy(node.text, N) : "") +
           (node.kind == Node::Kind::scalar && N == 3 && key.unit.empty() ? axis_remedy(node.text)
                                                                          : "") +
           (node.kind == Node::Kind::scalar && !node.quoted && key.form != nullptr
                ? number_remedy(node.text, key.unit)
                : "") +
           (node.items.size() > N ? "; commas part the numbers, decimals take a point" : "");
  std::array<T, N> values{};
  Key element = key;
  element.automatic = false;
  for (std::size_t i = 0; i < N; ++i) {
    const std::string problem = read_one(element, node.items[i], values[i]);
    if (!problem.empty()) return "element " + std::to_string(i) + ": " + problem;
  }
  out = values;
  return "";
}

std::string not_among(const std::vector<std::string>& choices, const Node& node) {
  std::string text = node.shown() + " is not one of " + joined(choices, ", ");
  const std::string near =
      node.kind == Node::Kind::scalar ? nearest_choice(node.text, choices) : std::string();
  return near.empty() ? text : text + "; did you mean " + near + "?";
}

/// Index of the word in the key's choices, or -1.
int choice_of(const Key& key, const Node& node) {
  if (node.kind != Node::Kind::scalar) return -1;
  const auto it = std::find(key.choices.begin(), key.choices.end(), node.text);
  return it == key.choices.end() ? -1 : static_cast<int>(it - key.choices.begin());
}

std::string read_text(const Key& key, const Node& node, std::string& out) {
  if (node.kind != Node::Kind::scalar) return instead_of("text", node);
  if (node.text.empty() && !may_be_empty(key)) return "is empty, expected text";
  if (node.text.size() > 1000) return "is longer than 1000 bytes";
  if (node.text.find_first_of("\n\r\t") != std::string::npos)
    return node.shown() + " holds a line break or a tab, expected one line";
  out = node.text;
  return "";
}

std::string read_words(const Key& key, const Node& node, std::vector<std::string>& out) {
  if (node.kind != Node::Kind::list) {
    const std::string near =
        node.kind == Node::Kind::scalar ? nearest_choice(node.text, key.choices) : std::string();
    if (key.choices.empty()) return instead_of("a list of names in brackets", node);
    return instead_of("a list of words such as [" + (near.empty() ? key.choices[0] : near) + "]",
                      node);
  }
  std::vector<std::string> words;
  for (const Node& item : node.items) {
    if (key.choices.empty() && (item.kind != Node::Kind::scalar || item.text.empty()))
      return instead_of("a name", item);
    if (!key.choices.empty() && choice_of(key, item) < 0) return not_among(key.choices, item);
    if (std::find(words.begin(), words.end(), item.text) != words.end())
      return item.shown() + " is listed twice";
    words.push_back(item.text);
  }
  out = words;
  return "";
}

struct Reader {
  const Key& key;
  const Node& node;

  template <class T>
  std::string operator()(std::optional<T>* field) const {
    if (node.is_word({"auto"})) {
      *field = std::nullopt;
      return "";
    }
    T value{};
    const std::string problem = (*this)(&value);
    if (problem.empty()) *field = value;
    return problem;
  }
  template <class T>
  requires std::is_arithmetic_v<T> std::string operator()(T* field) const {
    if (key.automatic && node.is_word({"auto"})) {
      *field = 0;
      return "";
    }
    return read_one(key, node, *field);
  }
  std::string operator()(bool* field) const {
    if (node.quoted || !node.is_word({"true", "false"})) {
      const std::string what = instead_of("true or false", node);
      if (node.is_word({"yes", "on", "True", "1"})) return what + "; write true";
      return node.is_word({"no", "off", "False", "0"}) ? what + "; write false" : what;
    }
    *field = node.text == "true";
    return "";
  }
  template <class T, std::size_t N>
  std::string operator()(std::array<T, N>* field) const {
    return read_numbers(key, node, *field);
  }
  std::string operator()(std::string* field) const { return read_text(key, node, *field); }
  std::string operator()(std::vector<std::string>* field) const {
    return read_words(key, node, *field);
  }
  std::string operator()(std::vector<double>* field) const {
    const std::size_t n = node.items.size();
    if (node.kind != Node::Kind::list || n < 1 || n > key.most)
      return instead_of("a list of 1 to " + std::to_string(key.most) + " numbers", node);
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i)
      if (const std::string problem = read_one(key, node.items[i], values[i]); !problem.empty())
        return "element " + std::to_string(i) + ": " + problem;
    *field = values;
    return "";
  }
  std::string operator()(const ChoiceField& field) const {
    const int index = choice_of(key, node);
    if (index < 0) return not_among(key.choices, node);
    field.set(index);
    return "";
  }
};

struct ValueWriter {
  const Key& key;

  template <class T>
  std::string operator()(const std::optional<T>* field) const {
    return *field ? ValueWriter{key}.plain(**field) : "auto";
  }
  template <class T>
  requires std::is_arithmetic_v<T> std::string operator()(const T* field) const {
    return key.automatic && *field == 0 ? "auto" : plain(*field);
  }
  std::string operator()(const bool* field) const { return *field ? "true" : "false"; }
  template <class T, std::size_t N>
  std::string operator()(const std::array<T, N>* field) const {
    return plain(*field);
  }
  std::string operator()(const std::string* field) const { return yaml_text(*field); }
  std::string operator()(const std::vector<std::string>* field) const {
    std::vector<std::string> words = *field;
    for (std::string& word : words)
      if (key.choices.empty()) word = yaml_text(word);
    return std::string("[").append(joined(words, ", ")).append("]");
  }
  std::string operator()(const std::vector<double>* field) const {
    std::string text = "[";
    for (const double v : *field) text += (text.size() > 1 ? ", " : "") + plain(v);
    return text + "]";
  }
  std::string operator()(const ChoiceField& field) const {
    return key.choices[static_cast<std::size_t>(field.get())];
  }

  static std::string plain(double v) { return to_text(v); }
  template <class T>
  requires std::is_integral_v<T>
  static std::string plain(T v) { return std::to_string(v); }
  template <class T, std::size_t N>
  static std::string plain(const std::array<T, N>& values) {
    std::string text;
    for (const T& v : values) text += (text.empty() ? "[" : ", ") + plain(v);
    return text + "]";
  }
};

}  // namespace

bool in_range(const Key& key, double v) {
  const Range& r = key.range;
  const bool below = r.above_min ? v <= r.min : v < r.min;
  const bool above = r.below_max ? v >= r.max : v > r.max;
  return !below && !above;
}

bool may_be_empty(const Key& key) {
  return !key.required && std::get<std::string*>(key.field(key.standard))->empty();
}

bool is_numeric(const Field& field) {
  return !std::holds_alternative<bool*>(field) && !std::holds_alternative<std::string*>(field) &&
         !std::holds_alternative<std::vector<std::string>*>(field) &&
         !std::holds_alternative<ChoiceField>(field);
}

std::size_t least_entries(const List& list, const Node& scene) {
  const Node* other = list.unless.empty() ? nullptr : scene.find(list.unless);
  return other && other->kind == Node::Kind::list && !other->items.empty() ? 0 : list.least;
}

std::string read_field(const Key& key, const Node& node, const Field& field) {
  if (node.kind == Node::Kind::null) return "has no value; write one or remove the key";
  return std::visit(Reader{key, node}, field);
}

std::string format_field(const Key& key, const Field& field) {
  return std::visit(ValueWriter{key}, field);
}

std::string yaml_text(const std::string& text) {
  static const std::string kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  const bool letter = !text.empty() && kLetters.find(text[0]) != text.npos;
  const bool safe = text.find_first_not_of(kLetters + "0123456789_-./") == text.npos;
  static const std::vector<std::string> kReserved{
      "null", "Null", "NULL", "true", "True", "TRUE", "false", "False", "FALSE",
      "yes",  "Yes",  "YES",  "no",   "No",   "NO",   "on",    "On",    "ON",
      "off",  "Off",  "OFF",  "y",    "Y",    "n",    "N"};
  const bool reserved = std::ranges::count(kReserved, text) > 0;
  if (letter && !reserved && safe) return text;
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

}  // namespace pbf::scene_module
