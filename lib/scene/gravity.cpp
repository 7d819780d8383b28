// Gravity by its magnitude: a number points straight down, a mapping may tilt it.
#include <cmath>

#include "lib/scene/key_rows.h"
#include "lib/scene/number.h"
#include "lib/scene/shorthand.h"
#include "lib/scene/validate.h"
#include "lib/scene/value.h"

namespace pbf::scene_module {
namespace {

/// In the order of kFaceNames.
enum class Side { x_min, x_max, y_min, y_max };

struct Tilted {
  double magnitude = 9.81;  ///< m/s^2
  double tilt = 0;          ///< degrees
  Side toward = Side::x_max;
};

/// Has the paths of the keys in a scene, for messages.
struct Form {
  Tilted gravity;
};

#define FORM_KEY(member) MEMBER(Form, member)

KeyRows rows() {
  return {{{"", "A scene."}, {"gravity", "Gravity by its magnitude."}},
          {key(FORM_KEY(gravity.magnitude), number("m/s^2", {0, 1e12}), "Its magnitude."),
           key(FORM_KEY(gravity.tilt), number("degrees", kCoordinate),
               "The angle between it and straight down, -z; 0 to 90."),
           key(FORM_KEY(gravity.toward), one_of({kFaceNames.begin(), kFaceNames.begin() + 4}),
               "The face of the domain to which it is tilted.")}};
}

const char* opposite(const Form& form) {
  return kFaceNames[std::size_t(static_cast<int>(form.gravity.toward) ^ 1)];
}

Double3 vector_of(const Tilted& g) {
  if (g.tilt == 0) return {0, 0, 0 - g.magnitude};
  const double angle = g.tilt * (3.14159265358979323846 / 180);
  const int axis = static_cast<int>(g.toward) / 2;
  const bool high = static_cast<int>(g.toward) % 2 == 1;
  Double3 out{};
  out[std::size_t(axis)] = (high ? 1 : -1) * g.magnitude * std::sin(angle);
  // At exactly 90 degrees the component is 0, although the computed cosine is not.
  out[2] = g.tilt == 90 ? 0 : 0 - g.magnitude * std::cos(angle);
  return out;
}

}  // namespace

const KeyTable& gravity_table() {
  static Form defaults;
  static const KeyTable table({rows()}, object(defaults));
  return table;
}

bool write_out_gravity(Node& root, Problems& problems) {
  Node* node = root.find("gravity");
  if (node == nullptr) return true;
  Form form;
  if (node->kind == Node::Kind::scalar && !node->quoted) {
    if (node->is_word({"off", "none", "false"})) {
      problems.add(node->place(), "gravity", "is " + node->text + "; write 0 for none");
      return false;
    }
    double g = 0;
    if (read_number(node->text, g) != NumberError::none) return true;  // reported when it is read
    if (g < 0) {
      problems.add(node->place(), "gravity",
                   "is " + node->text + ", and one number is its magnitude, straight down; write " +
                       to_text(-g) + ", or the vector [0, 0, " + to_text(g) + "]");
      return false;
    }
    form.gravity.magnitude = g;
    if (!in_range(*gravity_table().find_key("gravity.magnitude"), g)) return true;
  } else if (node->kind == Node::Kind::map) {
    Node tree = node->here(Node::Kind::map);
    tree.append(node->here(Node::Kind::scalar, "gravity"), *node);
    Problems own;
    if (!read_tree(gravity_table(), tree, object(form), own).bad.empty()) {
      read_tree(gravity_table(), tree, object(form), problems);
      return false;
    }
    const double tilt = form.gravity.tilt;
    if (!(tilt >= 0 && tilt <= 90)) {
      problems.add(node->find("tilt")->place(), "gravity.tilt",
                   "is " + to_text(tilt) + ", and gravity is tilted by 0 to 90 degrees from " +
                       "straight down; " +
                       (tilt < 0 ? "for the other way give toward: " + std::string(opposite(form))
                                 : "for one that points upward give the vector, [x, y, z]"));
      return false;
    }
  } else {
    return true;
  }
  const Double3 g = vector_of(form.gravity);
  *node = list_node(*node, {g[0], g[1], g[2]});
  return true;
}

}  // namespace pbf::scene_module
