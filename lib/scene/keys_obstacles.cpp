// Keys of obstacles: those of every one, and those of their shapes.
#include <tuple>

#include "lib/base/error.h"
#include "lib/scene/key_rows.h"

namespace pbf::inline scene_module {
namespace {

#define KEY(member) MEMBER(Scene, member)
#define OBSTACLE(member) MEMBER_OF(obstacles, Obstacle, member)

/// The key that decides which other keys an obstacle has.
Key shape_row() {
  Key row{"obstacles[].shape",
          "Shape of the obstacle; decides which keys it has. With dimensions: 2 y does not count, "
          "and a sphere is a disc.",
          [](const Object& holder) -> Field {
            Obstacle& o = *std::any_cast<Obstacle*>(holder);
            return ChoiceField{address_of_word(o.shape), [&o] { return int(o.shape.index()); },
                               [&o](int wanted) {
                                 if (wanted == int(o.shape.index())) return;
                                 int k = 0;
                                 for_each_shape([&](const auto& keys) {
                                   if (k++ == wanted) o.shape = keys;
                                 });
                               }};
          }};
  for_each_shape([&](const auto& keys) { row.choices.push_back(keys.word); });
  required(row), is_kind(row);
  return row;
}

/// The row of a shape's key. For an obstacle of another shape, reads give the default and writes
/// are lost.
template <class Shape, class Member, class Holder>
Key row_of(const ShapeKey<Member, Holder>& key, unsigned kind) {
  Key row{std::string("obstacles[].") + key.name, key.help,
          [member = key.member](const Object& holder) -> Field {
            if (Shape* held = std::get_if<Shape>(&std::any_cast<Obstacle*>(holder)->shape))
              return &(held->*member);
            static thread_local Shape standard;
            standard = {};
            return &(standard.*member);
          }};
  number(key.unit, key.range)(row);
  row.required = key.required, row.kinds = kind, row.flat = key.flat;
  row.by_center = key.by_center;
  return row;
}

std::vector<Key> shape_rows() {
  std::vector<Key> rows;
  for (const bool bounded : {true, false}) {  // pages list bounded shapes before planes
    unsigned kind = 1;
    for_each_shape([&]<class Shape>(const Shape&) {
      if (requires { Shape::Body::endless; } != bounded)
        std::apply(
            [&](const auto&... key) { (add_shape_row(rows, row_of<Shape>(key, kind)), ...); },
            Shape::keys());
      kind *= 2;
    });
  }
  return rows;
}

}  // namespace

void add_shape_row(std::vector<Key>& rows, Key row) {
  const auto there = std::ranges::find(rows, row.path, &Key::path);
  if (there == rows.end()) return rows.push_back(std::move(row));
  const auto said = [](const Key& k) { return std::tie(k.help, k.unit, k.required, k.by_center); };
  if (said(row) != said(*there) || row.range != there->range ||
      (row.flat != there->flat && row.flat != FlatY::middle))
    throw Error(ExitCode::internal, row.path +
                                        ": two shapes have this key and differ in its help, "
                                        "unit, range or traits; give them one text, or the "
                                        "keys different names");
  if (row.flat != there->flat) there->in_plane |= row.kinds;
  there->field = [first = there->field, second = row.field, kind = row.kinds](const Object& o) {
    const auto held = std::any_cast<Obstacle*>(o)->shape.index();
    return kind >> held & 1 ? second(o) : first(o);
  };
  there->kinds |= row.kinds;
}

KeyRows obstacle_rows() {
  KeyRows all{
      {list_block(KEY(obstacles), "Solids that the fluid flows around",
                  {.entry_name = "obstacle",
                   .remark = "particles of bodies in them are left out",
                   .example = "{name: block, shape: box, min: [0.4, 0.4, 0], max: [0.6, 0.6, 0.3]}",
                   .further = "{name: ball, shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.1, "
                              "loads: true}"},
                  exact("all solvers of a comparison have the same solids"))},
      {key(OBSTACLE(name), plain, "Name, in the columns of the log.", required), shape_row()}};
  for (Key& row : shape_rows()) all.keys.push_back(std::move(row));
  all.keys.push_back(key(OBSTACLE(loads), plain,
                         "Sums the force and the torque of the fluid on it; columns "
                         "load/NAME/force_x and so on of the log."));
  return all;
}

}  // namespace pbf::inline scene_module
