#include "lib/scene/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "lib/base/plain_text.h"
#include "lib/scene/remedies.h"

namespace pbf::scene_module {
namespace {

struct Refused {
  YAML::Mark mark;
  std::string what;
};

/// Offsets of the lines of a text; the first is after a byte order mark.
std::vector<std::size_t> line_starts(const std::string& text) {
  std::vector<std::size_t> starts{text.rfind("\xEF\xBB\xBF", 0) == 0 ? std::size_t{3} : 0};
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos;) starts.push_back(++at);
  return starts;
}

/// Builds the tree from the parser's events; throws Refused for features that scenes may not use.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& text, const Origin& origin, bool lines)
      : text_(text),
        starts_(line_starts(text)),
        origin_(std::make_shared<const Origin>(origin)),
        lines_(lines) {}

  Node take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ == 0) return;
    if (line_of(mark).rfind("---", 0) == 0)
      throw Refused{mark, "a second document starts here; a scene file holds one"};
    // A comment ends a text, so "name:demo  # about" makes the next line a new document.
    const std::string remedy = lines_ ? layout_remedy(text_, mark.line) : "";
    throw Refused{mark, "not valid YAML: the lines above end before this one" + remedy};
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    Node node = make(mark, Node::Kind::null);
    node.text = null_word(mark);
    add(std::move(node));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw Refused{mark, "aliases (*name) are not supported; write the value out"};
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    if (const auto bad = find_bad_text(value))  // an escape ("\e") can make any character
      throw Refused{mark, "an escape makes " + bad->what + "; leave it out"};
    Node node = make(mark, Node::Kind::scalar);
    node.text = value;
    node.quoted = tag == "!";
    add(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, Node::Kind::list);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, Node::Kind::map);
  }
  void OnMapEnd() override { close(); }

 private:
  Node make(const YAML::Mark& mark, Node::Kind kind) const {
    return {kind, "", false, {}, {}, origin_, lines_ ? mark.line : -1, lines_ ? mark.column : -1};
  }
  /// yaml-cpp does not distinguish a missing value from a written "null"; this does.
  std::string null_word(const YAML::Mark& mark) const {
    if (mark.line < 0 || std::size_t(mark.line) >= starts_.size()) return "";
    const std::size_t at = starts_[std::size_t(mark.line)] + std::size_t(mark.column);
    for (const char* word : {"null", "Null", "NULL", "~"}) {
      const std::size_t end = at + std::string_view(word).size();
      if (text_.compare(at < text_.size() ? at : 0, end - at, word) == 0 &&
          (end >= text_.size() || std::string_view(" \t\r\n,]}").find(text_[end]) != text_.npos))
        return word;
    }
    return "";
  }
  std::string_view line_of(const YAML::Mark& mark) const {
    if (mark.line < 0 || std::size_t(mark.line) >= starts_.size()) return "";
    const std::size_t start = starts_[std::size_t(mark.line)];
    return std::string_view(text_).substr(start, text_.find('\n', start) - start);
  }
  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != 0) throw Refused{mark, "anchors (&name) are not supported; write the value out"};
  }
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw Refused{mark, "tags (!name) are not supported; write the value alone"};
  }
  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            Node::Kind kind) {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    // Thrown while the parser descends, which bounds its recursion as well as ours.
    if (open_.size() >= kMaxYamlDepth)
      throw Refused{mark, "nested deeper than " + std::to_string(kMaxYamlDepth) + " levels"};
    open_.push_back(make(mark, kind));
  }
  void close() {
    Node node = std::move(open_.back());
    open_.pop_back();
    add(std::move(node));
  }
  void add(Node&& node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Node& parent = open_.back();
    const bool is_key = parent.kind == Node::Kind::map && parent.keys.size() == parent.items.size();
    (is_key ? parent.keys : parent.items).push_back(std::move(node));
  }

  const std::string& text_;
  std::vector<std::size_t> starts_;
  std::shared_ptr<const Origin> origin_;
  bool lines_;
  int documents_ = 0;
  std::vector<Node> open_;
  Node root_;
};

std::string place_of(const Origin& origin, bool lines, int line, int column) {
  if (!lines || line < 0) return origin.shown();
  return origin.name + ":" + std::to_string(line + 1) + ":" + std::to_string(column + 1) +
         origin.included;
}

/// YAML forbids tabs for indentation, but the message of yaml-cpp does not say so.
void refuse_tabs(const std::string& text, const Origin& origin, bool lines) {
  int number = 0;
  for (std::size_t start = 0; start < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    // Search only this line: a search to the end of the text makes the loop quadratic.
    const std::string_view line = std::string_view(text).substr(start, end - start);
    const std::size_t first = line.find_first_not_of(" \t\r"), tab = line.find('\t');
    if (first != line.npos && tab < first && line[first] != '#')
      throw YamlError{place_of(origin, lines, number, static_cast<int>(tab)),
                      "a tab indents this line; YAML allows spaces only"};
    start = end + 1;
  }
}

}  // namespace

std::string Node::place() const {
  return origin ? place_of(*origin, line >= 0, line, column) : std::string();
}

Node* Node::find(const std::string& key) {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].kind == Kind::scalar && keys[i].text == key) return &items[i];
  return nullptr;
}

void Node::erase(const std::string& key) {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].kind == Kind::scalar && keys[i].text == key) {
      keys.erase(keys.begin() + std::ptrdiff_t(i));
      items.erase(items.begin() + std::ptrdiff_t(i));
      return;
    }
}

bool Node::is_word(std::initializer_list<const char*> words) const {
  return kind == Kind::scalar && std::find(words.begin(), words.end(), text) != words.end();
}

std::string Node::shown() const {
  if (kind == Kind::null) return "nothing";
  if (kind == Kind::list) return "a list of " + std::to_string(items.size());
  if (kind == Kind::map) return "a block";
  return std::string("\"").append(one_line(text, 60)) + "\"";
}

Node parse_yaml(const std::string& text, const Origin& origin, bool lines) {
  refuse_tabs(text, origin, lines);
  TreeBuilder builder(text, origin, lines);
  try {
    // Trim the end: with trailing blanks yaml-cpp 0.7 does not detect a missing closing quote.
    std::istringstream in(text.substr(0, text.find_last_not_of(" \t\r\n") + 1));
    YAML::Parser parser(in);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const Refused& e) {
    throw YamlError{place_of(origin, lines, e.mark.line, e.mark.column), e.what};
  } catch (const YAML::Exception& e) {
    throw YamlError{
        place_of(origin, lines, e.mark.line, e.mark.column),
        "not valid YAML: " + e.msg + (lines ? layout_remedy(text, e.mark.line, e.msg) : "")};
  }
  return builder.take();
}

void visit(Node& at, const std::string& path, const std::function<void(Node&, Node&)>& f) {
  if (at.kind != Node::Kind::map) return;
  if (Node* value = at.find(path)) f(*value, at);  // also for a path in one word
  const std::size_t dot = path.find('.');
  if (dot == path.npos) return;
  const std::string first = path.substr(0, dot), rest = path.substr(dot + 1);
  const std::size_t bracket = first.find('[');
  Node* child = at.find(first.substr(0, bracket));
  if (child == nullptr) return;
  if (bracket == first.npos) return visit(*child, rest, f);
  if (child->kind == Node::Kind::list)
    for (Node& item : child->items) visit(item, rest, f);
}

}  // namespace pbf::scene_module
